// SPDX-License-Identifier: Apache-2.0
// Visitors that ask for the next thing as soon as they have got the last.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace vitrine::bench {

struct Load {
  std::uint16_t port;
  std::vector<std::string> requests;  // asked for in turn, each with its whole header
  int status;                         // of every answer
  std::size_t connections = 64;
  std::chrono::milliseconds time{1000};
};

struct Delivery {
  double requests_per_second = 0;
  double p50 = 0, p99 = 0;  // seconds from a request to its last byte
  std::uint64_t answers = 0;
};

// On this thread. Bodies are discarded by the kernel, so that the client is not what is measured.
// Throws where an answer is not as it should be.
Delivery deliver(const Load& load);

}  // namespace vitrine::bench
