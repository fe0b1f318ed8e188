// SPDX-License-Identifier: Apache-2.0
// What netem would do, where a kernel has none: a cable between two TUN devices, whose packets
// arrive late.
#pragma once

#include <chrono>
#include <deque>
#include <string>
#include <thread>
#include <vector>

#include "codec/files/file_descriptor.h"

namespace vitrine::bench {

// A new TUN device of this thread's network namespace; gone when it is closed. Throws where the
// kernel refuses.
FileDescriptor tun_device(const std::string& name);

class DelayLine {
 public:
  // Carries packets both ways, in order; each is `delay` on its way.
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

    void take(Clock::time_point due);  // what is there
    void give(Clock::time_point now);  // what is due
  };

  void run();
  Clock::time_point next_due() const;

  FileDescriptor a_, b_, end_;
  std::chrono::microseconds delay_;
  Way ways_[2];
  std::thread thread_;
};

}  // namespace vitrine::bench
