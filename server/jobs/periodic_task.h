// SPDX-License-Identifier: Apache-2.0
// Runs a function at regular intervals on a thread of its own.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "server/log/log.h"

namespace vitrine::server {

// Runs the task repeatedly until the object is destroyed, with `pause` before each run. If the task
// throws (for example, out of memory), logs the exception and runs the task again after the next
// pause. The log must outlive the object.
class PeriodicTask {
 public:
  PeriodicTask(std::chrono::milliseconds pause, const Log& events, std::function<void()> task)
      : events_(events),
        task_(std::move(task)),
        thread_([this, pause](const std::stop_token& stop) { run(stop, pause); }) {}

 private:
  void run(const std::stop_token& stop, std::chrono::milliseconds pause) {
    std::unique_lock lock(mutex_);
    while (!pause_.wait_for(lock, stop, pause, [&] { return stop.stop_requested(); })) {
      try {
        task_();
      } catch (const std::exception& fault) {
        events_.event(Severity::kError, fault.what());
      }
    }
  }

  const Log& events_;
  const std::function<void()> task_;
  std::mutex mutex_;
  std::condition_variable_any pause_;
  std::jthread thread_;
};

}  // namespace vitrine::server
