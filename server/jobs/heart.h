// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "server/log/log.h"

namespace vitrine {

// Does something again and again, a pause apart, in a thread of its own, as long as it lives. What
// is thrown meanwhile (memory has run out) is told, and the next beat may have more luck. The log
// outlives it.
class Heart {
 public:
  Heart(std::chrono::milliseconds pause, const Log& events, std::function<void()> beat)
      : events_(events),
        beat_(std::move(beat)),
        thread_([this, pause](const std::stop_token& stop) { run(stop, pause); }) {}

 private:
  void run(const std::stop_token& stop, std::chrono::milliseconds pause) {
    std::unique_lock lock(mutex_);
    while (!rest_.wait_for(lock, stop, pause, [&] { return stop.stop_requested(); })) {
      try {
        beat_();
      } catch (const std::exception& fault) {
        events_.event(Severity::kError, fault.what());
      }
    }
  }

  const Log& events_;
  const std::function<void()> beat_;
  std::mutex mutex_;
  std::condition_variable_any rest_;
  std::jthread thread_;
};

}  // namespace vitrine
