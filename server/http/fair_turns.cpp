// SPDX-License-Identifier: Apache-2.0
#include "server/http/fair_turns.h"

#include <utility>

namespace vitrine::server {

asio::awaitable<FairTurns::Turn> FairTurns::wait(std::string owner, std::string target) {
  asio::steady_timer timer(co_await asio::this_coro::executor,
                           asio::steady_timer::time_point::max());
  const auto waiter =
      std::make_shared<Waiter>(Waiter{std::move(timer), std::move(owner), std::move(target)});
  push(waiter);
  give_turns(waiter);
  while (!waiter->turn)
    co_await waiter->timer.async_wait(kNoThrow);
  co_return std::move(waiter->turn);
}

void FairTurns::stop() {
  const std::scoped_lock lock(mutex_);
  is_stopped_ = true;
}

void FairTurns::push(const std::shared_ptr<Waiter>& waiter) {
  const std::scoped_lock lock(mutex_);
  OwnersTasks& tasks = tasks_of_[waiter->owner];
  if (tasks.admitted == per_owner_) {
    tasks.further.push_back(waiter);
  } else {
    waiting_.push(waiter->owner, waiter);
    ++tasks.admitted;
  }
}

void FairTurns::give_turns(const std::shared_ptr<Waiter>& here) {
  while (const auto next = take_next()) {
    Turn turn = turn_of(*next);
    if (next == here) {
      next->turn = std::move(turn);
      continue;
    }
    asio::post(next->timer.get_executor(), [next, turn = std::move(turn)]() mutable {
      next->turn = std::move(turn);
      next->timer.cancel();
    });
  }
}

std::shared_ptr<FairTurns::Waiter> FairTurns::take_next() {
  const auto is_ready = [this](const std::shared_ptr<Waiter>& waiter) {
    return !running_.contains(waiter->target);
  };
  const std::scoped_lock lock(mutex_);
  if (free_ == 0 || is_stopped_) return nullptr;
  auto next = waiting_.take(is_ready);
  if (!next) return nullptr;
  if (!(*next)->target.empty()) running_.insert((*next)->target);
  --free_;
  return std::move(*next);
}

// Begins the waiter's turn. The caller must not hold the lock: if memory runs out, the turn ends
// immediately, and end() acquires the lock.
FairTurns::Turn FairTurns::turn_of(Waiter& waiter) {
  return {this, [self = shared_from_this(), owner = std::move(waiter.owner),
                 target = std::move(waiter.target)](const void*) { self->end(owner, target); }};
}

void FairTurns::end(const std::string& owner, const std::string& target) {
  {
    const std::scoped_lock lock(mutex_);
    running_.erase(target);
    ++free_;
    const auto found = tasks_of_.find(owner);
    auto& [admitted, further] = found->second;
    if (!further.empty()) {
      waiting_.push(owner, std::move(further.front()));
      further.pop_front();
    } else if (--admitted == 0) {
      tasks_of_.erase(found);
    }
  }
  give_turns(nullptr);
}

}  // namespace vitrine::server
