// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/lane.h"

#include <exception>
#include <utility>

namespace vitrine {

Lane::Lane(const Log& events) : events_(events), thread_([this] { work(); }) {}

void Lane::post(std::function<void()> task) {
  const std::scoped_lock lock(mutex_);
  waiting_.push_back(std::move(task));
  changed_.notify_one();
}

void Lane::when_idle(std::chrono::milliseconds for_so_long, std::function<void()> task) {
  const std::scoped_lock lock(mutex_);
  patience_ = for_so_long;
  at_rest_ = std::move(task);
}

void Lane::finish() {
  {
    const std::scoped_lock lock(mutex_);
    finishing_ = true;
    changed_.notify_one();
  }
  if (thread_.joinable()) thread_.join();
}

void Lane::work() {
  const auto is_wanted = [this] { return finishing_ || !waiting_.empty(); };
  std::unique_lock lock(mutex_);
  for (bool has_worked = false;;) {
    const bool is_idle = has_worked && at_rest_ && !changed_.wait_for(lock, patience_, is_wanted);
    if (!is_idle) changed_.wait(lock, is_wanted);
    if (!is_idle && waiting_.empty()) return;
    const auto task = is_idle ? at_rest_ : std::exchange(waiting_.front(), {});
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

}  // namespace vitrine
