// SPDX-License-Identifier: Apache-2.0
#include "server/http/fair_turns.h"

#include <chrono>
#include <new>
#include <utility>

namespace vitrine::server {
namespace {

// If memory runs out, give_turns() may fail to wake a waiter, and admit() may fail to put a waiter
// into the queue. Each waiter therefore checks again after this time.
constexpr std::chrono::seconds kRetryAfter{1};

}  // namespace

FairTurns::Task::~Task() {
  if (turns) turns->end(*this);
}

asio::awaitable<FairTurns::Turn> FairTurns::wait(std::string owner, std::string target) {
  auto task = std::make_shared<Task>(std::move(owner), std::move(target));
  asio::steady_timer timer(co_await asio::this_coro::executor);
  const auto waiter = std::make_shared<Waiter>(Waiter{std::move(timer), task});
  push(waiter);
  while (!begins(waiter)) {
    waiter->timer.expires_after(kRetryAfter);
    co_await waiter->timer.async_wait(kNoThrow);
  }
  co_return task;
}

void FairTurns::stop() {
  const std::scoped_lock lock(mutex_);
  is_stopped_ = true;
}

void FairTurns::push(const std::shared_ptr<Waiter>& waiter) {
  const std::scoped_lock lock(mutex_);
  tasks_of_[waiter->task->owner].further.push_back(waiter);
}

bool FairTurns::begins(const std::shared_ptr<Waiter>& waiter) {
  {
    const std::scoped_lock lock(mutex_);
    const std::string& owner = waiter->task->owner;
    admit(owner, tasks_of_.at(owner));
  }
  give_turns(waiter);
  const std::scoped_lock lock(mutex_);
  return waiter->task->turns != nullptr;
}

void FairTurns::admit(const std::string& owner, OwnersTasks& tasks) {
  try {
    while (tasks.admitted < per_owner_ && !tasks.further.empty()) {
      const auto& next = tasks.further.front();
      waiting_.push(owner, next, next->task->target);
      tasks.further.pop_front();
      ++tasks.admitted;
    }
  } catch (const std::bad_alloc&) {  // the further tasks try again after kRetryAfter
  }
}

void FairTurns::give_turns(const std::shared_ptr<Waiter>& here) {
  while (const auto next = take_next()) {
    if (next == here) continue;
    try {
      asio::post(next->timer.get_executor(), [next] { next->timer.cancel(); });
    } catch (const std::bad_alloc&) {  // the waiter notices its turn after kRetryAfter
    }
  }
}

// Allocates no memory, so that no waiter is lost.
std::shared_ptr<FairTurns::Waiter> FairTurns::take_next() {
  const std::scoped_lock lock(mutex_);
  if (free_ == 0 || is_stopped_) return nullptr;
  auto next = waiting_.take();
  if (!next) return nullptr;
  (*next)->task->turns = shared_from_this();
  --free_;
  return std::move(*next);
}

void FairTurns::end(const Task& task) {
  {
    const std::scoped_lock lock(mutex_);
    waiting_.finish(task.target);
    ++free_;
    const auto found = tasks_of_.find(task.owner);
    OwnersTasks& tasks = found->second;
    --tasks.admitted;
    admit(task.owner, tasks);
    if (tasks.admitted == 0 && tasks.further.empty()) tasks_of_.erase(found);
  }
  give_turns(nullptr);
}

}  // namespace vitrine::server
