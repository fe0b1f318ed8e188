// SPDX-License-Identifier: Apache-2.0
// HTTP clients that send the next request as soon as the last response is complete.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace vitrine::bench {

struct Load {
  std::uint16_t port;
  std::vector<std::string> requests;  // complete HTTP requests; sent in this order, repeatedly
  int status;                         // expected HTTP status of every response
  std::size_t connections = 64;
  std::chrono::milliseconds time{1000};
};

struct Delivery {
  double requests_per_second = 0;
  double p50 = 0, p99 = 0;  // seconds from a request to the last byte of its response
  std::uint64_t answers = 0;
};

// Runs the clients on this thread. The kernel discards the bodies, so that reading does not limit
// the rate. Throws if a response is not as expected.
Delivery deliver(const Load& load);

}  // namespace vitrine::bench
