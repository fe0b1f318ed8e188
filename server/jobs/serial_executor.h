// SPDX-License-Identifier: Apache-2.0
// A thread that runs tasks one after the other, in the order in which they were posted. If a task
// throws (for example, out of memory), the exception is logged and the next task runs. The log must
// outlive the executor.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <thread>

#include "server/log/log.h"

namespace vitrine::server {

class SerialExecutor {
 public:
  explicit SerialExecutor(const Log& events);
  ~SerialExecutor() { finish(); }  // runs the waiting tasks first
  SerialExecutor(const SerialExecutor&) = delete;
  SerialExecutor& operator=(const SerialExecutor&) = delete;

  void post(std::function<void()> task);

  // Runs `task` on the executor's thread and returns its result. A task of this executor must not
  // call run().
  template <class Task>
  auto run(Task task) {
    std::packaged_task<decltype(task())()> packaged(std::move(task));
    auto result = packaged.get_future();
    post([&packaged] { packaged(); });
    return result.get();
  }

  // Sets a task that the executor's thread runs whenever `timeout` has passed without a new task.
  void when_idle(std::chrono::milliseconds timeout, std::function<void()> task);

  // Runs the waiting tasks and ends the thread. No task may be posted afterwards.
  void finish();

 private:
  void work();

  const Log& events_;
  std::mutex mutex_;  // guards the members up to when_idle_
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool is_finishing_ = false;
  std::chrono::milliseconds idle_timeout_{0};
  std::function<void()> when_idle_;

  std::thread thread_;
};

}  // namespace vitrine::server
