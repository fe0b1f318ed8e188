// SPDX-License-Identifier: Apache-2.0
// A simulated cable between two TUN devices, which delays packets. Used instead of netem, which
// some kernels lack.
#pragma once

#include <chrono>
#include <deque>
#include <string>
#include <thread>
#include <vector>

#include "codec/files/file_descriptor.h"

namespace vitrine::bench {

// Creates a TUN device in this thread's network namespace. Closing the descriptor removes the
// device. Throws if the kernel refuses.
FileDescriptor tun_device(const std::string& name);

class DelayLine {
 public:
  // Carries packets in both directions and in order. Each packet takes `delay`.
  DelayLine(FileDescriptor a, FileDescriptor b, std::chrono::microseconds delay);
  ~DelayLine();
  DelayLine(const DelayLine&) = delete;
  DelayLine& operator=(const DelayLine&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  struct Packet {
    Clock::time_point due;
    std::vector<char> bytes;
  };
  struct Way {
    int from, to;
    std::deque<Packet> packets = {};

    void take(Clock::time_point due);  // reads all packets that are available
    void give(Clock::time_point now);  // writes all packets that are due
  };

  void run();
  Clock::time_point next_due() const;

  FileDescriptor a_, b_, end_;
  std::chrono::microseconds delay_;
  Way ways_[2];
  std::thread thread_;
};

}  // namespace vitrine::bench
