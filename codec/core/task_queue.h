// SPDX-License-Identifier: Apache-2.0
// Runs tasks on worker threads and on the thread that adds them.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <mutex>
#include <vector>

namespace vitrine::inline codec {

// Starts the tasks in the order in which they were added. All calls must come from the same thread.
class TaskQueue {
 public:
  struct Task {
    std::function<void()> run;
    std::size_t weight;  // an estimate of the task's memory, in any unit
  };

  // Uses at most `threads` (>= 1) threads, one of which is the caller's. The weights of all tasks
  // that wait or run add up to at most `most_weight`, unless a single task exceeds that weight.
  TaskQueue(unsigned threads, std::size_t most_weight);
  // Drops the waiting tasks. Waits for the running tasks to end.
  ~TaskQueue();
  TaskQueue(const TaskQueue&) = delete;

  // Blocks until a task of this weight may be added. Runs waiting tasks meanwhile.
  void make_room(std::size_t weight);
  // Adds a task. If more tasks are waiting than there are worker threads, runs the oldest waiting
  // task on the caller's thread.
  void add(Task task);
  // Runs the waiting tasks. Returns after all tasks have ended. If tasks have thrown, rethrows the
  // first exception.
  void finish();

 private:
  void work();
  bool run_oldest(std::unique_lock<std::mutex>& lock);

  const std::size_t most_weight_;
  std::mutex mutex_;
  std::condition_variable changed_;  // notified if a task is added or ends, or is_closed_ is set
  std::deque<Task> waiting_;
  std::size_t weight_ = 0;   // total weight of the tasks that wait or run
  std::size_t running_ = 0;  // number of tasks that run
  bool is_closed_ = false;
  std::exception_ptr failure_;  // the first exception of a task
  std::vector<std::future<void>> workers_;
};

}  // namespace vitrine::inline codec
