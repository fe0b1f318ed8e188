// SPDX-License-Identifier: Apache-2.0
// A thread that does one thing after another, in the order in which they were handed in. What one
// of them throws (memory has run out) is told, and the next is done. The log outlives it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <thread>

#include "server/log/log.h"

namespace vitrine {

class Lane {
 public:
  explicit Lane(const Log& events);
  ~Lane() { finish(); }  // what is waiting is done first
  Lane(const Lane&) = delete;
  Lane& operator=(const Lane&) = delete;

  void post(std::function<void()> task);

  // Has `task` done there and returns what it returns. Not to be called by the lane's own tasks.
  template <class Task>
  auto run(Task task) {
    std::packaged_task<decltype(task())()> packaged(std::move(task));
    auto result = packaged.get_future();
    post([&packaged] { packaged(); });
    return result.get();
  }

  // Has `task` done there each time that nothing was handed in for so long after something else.
  void when_idle(std::chrono::milliseconds for_so_long, std::function<void()> task);

  // Does what is waiting and ends. Nothing may be handed in afterwards.
  void finish();

 private:
  void work();

  const Log& events_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool finishing_ = false;
  std::chrono::milliseconds patience_{0};
  std::function<void()> at_rest_;

  std::thread thread_;
};

}  // namespace vitrine
