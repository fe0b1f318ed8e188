// SPDX-License-Identifier: Apache-2.0
#include "server/http/fair_turns.h"

#include <utility>

namespace vitrine::server {

asio::awaitable<FairTurns::Turn> FairTurns::wait(std::string owner, std::string target) {
  asio::steady_timer timer(co_await asio::this_coro::executor,
                           asio::steady_timer::time_point::max());
  const auto waiter = std::make_shared<Waiter>(Waiter{std::move(timer), std::move(target)});
  {
    const std::scoped_lock lock(mutex_);
    waiting_.push(owner, waiter);
  }
  give_turns();
  while (!waiter->turn)
    co_await waiter->timer.async_wait(kNoThrow);
  co_return std::move(waiter->turn);
}

void FairTurns::stop() {
  const std::scoped_lock lock(mutex_);
  is_stopped_ = true;
}

void FairTurns::give_turns() {
  while (const auto next = take_next())
    begin(next);
}

std::shared_ptr<FairTurns::Waiter> FairTurns::take_next() {
  const auto is_ready = [this](const std::shared_ptr<Waiter>& waiter) {
    return !running_.contains(waiter->target);
  };
  const std::scoped_lock lock(mutex_);
  if (free_ == 0 || is_stopped_) return nullptr;
  auto next = waiting_.take(is_ready);
  if (!next) return nullptr;
  running_.insert((*next)->target);
  --free_;
  return std::move(*next);
}

// Starts the waiter's turn. The caller must not hold the lock: if memory runs out, the turn ends
// immediately, and end() acquires the lock.
void FairTurns::begin(const std::shared_ptr<Waiter>& waiter) {
  auto on_end = [self = shared_from_this(), target = std::move(waiter->target)](const void*) {
    self->end(target);
  };
  asio::post(waiter->timer.get_executor(),
             [waiter, turn = Turn(this, std::move(on_end))]() mutable {
               waiter->turn = std::move(turn);
               waiter->timer.cancel();
             });
}

void FairTurns::end(const std::string& target) {
  {
    const std::scoped_lock lock(mutex_);
    running_.erase(target);
    ++free_;
  }
  give_turns();
}

}  // namespace vitrine::server
