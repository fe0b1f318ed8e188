// SPDX-License-Identifier: Apache-2.0
// Lets callers that wait for the same task learn that it has failed for one of them.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace vitrine::server {

// Thread-safe.
class SharedFailures {
 public:
  // True once the task has failed.
  using HasFailed = std::shared_ptr<const std::atomic<bool>>;

  // Begins to wait for the task `name`. The caller waits as long as it holds the result. Callers
  // that join after a failure do not share it.
  HasFailed join(const std::string& name) {
    const std::scoped_lock lock(mutex_);
    std::erase_if(waiting_, [](const auto& entry) { return entry.second.expired(); });
    auto& entry = waiting_[name];
    auto flag = entry.lock();
    if (!flag) entry = flag = std::make_shared<std::atomic<bool>>(false);
    return flag;
  }

  // Tells all callers that wait for the task that it has failed.
  void fail(const std::string& name) {
    const std::scoped_lock lock(mutex_);
    const auto entry = waiting_.extract(name);
    if (const auto flag = entry ? entry.mapped().lock() : nullptr) *flag = true;
  }

 private:
  std::mutex mutex_;  // guards the members below
  std::map<std::string, std::weak_ptr<std::atomic<bool>>> waiting_;
};

}  // namespace vitrine::server
