// SPDX-License-Identifier: Apache-2.0
#include "codec/core/task_queue.h"

#include <utility>

namespace vitrine::inline codec {
namespace {

std::exception_ptr failure_of(const std::function<void()>& run) {
  try {
    run();
  } catch (...) {
    return std::current_exception();
  }
  return nullptr;
}

}  // namespace

TaskQueue::TaskQueue(unsigned threads, std::size_t most_weight) : most_weight_(most_weight) {
  for (unsigned t = 1; t < threads; ++t)
    workers_.push_back(std::async(std::launch::async, [this] { work(); }));
}

// The destructors of the futures in `workers_` wait until the threads have ended.
TaskQueue::~TaskQueue() {
  const std::lock_guard lock(mutex_);
  waiting_.clear();
  is_closed_ = true;
  changed_.notify_all();
}

void TaskQueue::make_room(std::size_t weight) {
  std::unique_lock lock(mutex_);
  while (weight_ > 0 && weight_ + weight > most_weight_) {
    if (!run_oldest(lock)) changed_.wait(lock);
  }
}

void TaskQueue::add(Task task) {
  std::unique_lock lock(mutex_);
  weight_ += task.weight;
  waiting_.push_back(std::move(task));
  changed_.notify_all();
  if (waiting_.size() > workers_.size()) run_oldest(lock);
}

void TaskQueue::finish() {
  std::unique_lock lock(mutex_);
  while (running_ > 0 || !waiting_.empty()) {
    if (!run_oldest(lock)) changed_.wait(lock);
  }
  if (failure_) std::rethrow_exception(failure_);
}

void TaskQueue::work() {
  std::unique_lock lock(mutex_);
  while (!is_closed_) {
    if (!run_oldest(lock)) changed_.wait(lock);
  }
}

// Runs the oldest waiting task, with the mutex unlocked. Returns false if no task is waiting.
bool TaskQueue::run_oldest(std::unique_lock<std::mutex>& lock) {
  if (waiting_.empty()) return false;
  Task task = std::move(waiting_.front());
  waiting_.pop_front();
  ++running_;
  lock.unlock();
  const std::exception_ptr failure = failure_of(task.run);
  task.run = {};
  lock.lock();
  if (!failure_) failure_ = failure;
  --running_;
  weight_ -= task.weight;
  changed_.notify_all();
  return true;
}

}  // namespace vitrine::inline codec
