// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/serial_executor.h"

#include <exception>
#include <utility>

namespace vitrine::server {

SerialExecutor::SerialExecutor(const Log& events) : events_(events), thread_([this] { work(); }) {}

void SerialExecutor::post(std::function<void()> task) {
  const std::scoped_lock lock(mutex_);
  waiting_.push_back(std::move(task));
  changed_.notify_one();
}

void SerialExecutor::when_idle(std::chrono::milliseconds timeout, std::function<void()> task) {
  const std::scoped_lock lock(mutex_);
  idle_timeout_ = timeout;
  when_idle_ = std::move(task);
}

void SerialExecutor::finish() {
  {
    const std::scoped_lock lock(mutex_);
    is_finishing_ = true;
    changed_.notify_one();
  }
  if (thread_.joinable()) thread_.join();
}

void SerialExecutor::work() {
  const auto is_wanted = [this] { return is_finishing_ || !waiting_.empty(); };
  std::unique_lock lock(mutex_);
  for (bool has_worked = false;;) {
    const bool is_idle =
        has_worked && when_idle_ && !changed_.wait_for(lock, idle_timeout_, is_wanted);
    if (!is_idle) changed_.wait(lock, is_wanted);
    if (!is_idle && waiting_.empty()) return;
    const auto task = is_idle ? when_idle_ : std::exchange(waiting_.front(), {});
    if (!is_idle) waiting_.pop_front();
    has_worked = !is_idle;
    lock.unlock();
    try {
      task();
    } catch (const std::exception& fault) {
      events_.event(Severity::kError, fault.what());
    }
    lock.lock();
  }
}

}  // namespace vitrine::server
