// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/lane.h"

#include <utility>

namespace vitrine {

Lane::Lane() : thread_([this] { work(); }) {}

void Lane::post(std::function<void()> task) {
  const std::scoped_lock lock(mutex_);
  waiting_.push_back(std::move(task));
  changed_.notify_one();
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
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return finishing_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const auto task = std::exchange(waiting_.front(), {});
    waiting_.pop_front();
    lock.unlock();
    task();
    lock.lock();
  }
}

}  // namespace vitrine
