// SPDX-License-Identifier: Apache-2.0
// Limits how many tasks run at the same time. Each task belongs to an owner, and the owners take
// turns. An owner with many tasks therefore delays every other owner by only one task.
#pragma once

#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "server/auth/fair_queue.h"
#include "server/http/beast.h"

namespace vitrine::server {

// Thread-safe. Must be owned by a shared pointer, because each turn keeps the object alive.
class FairTurns : public std::enable_shared_from_this<FairTurns> {
 public:
  explicit FairTurns(std::size_t at_a_time) : free_(at_a_time) {}

  // A turn: the permission to run one task. It lasts until its last copy is destroyed.
  using Turn = std::shared_ptr<const void>;
  // Waits for a turn of `owner`. Tasks with equal targets run one after the other. Must be called
  // on a strand.
  asio::awaitable<Turn> wait(std::string owner, std::string target);

  void stop();  // no turn begins after this call

 private:
  struct Waiter {
    asio::steady_timer timer;
    std::string target;   // empty once the waiter has its turn
    Turn turn = nullptr;  // used only on the timer's strand
  };
  void give_turns();
  // Removes the next waiter from the queue and marks its target as running. Returns null if no turn
  // is free, or no waiter is ready.
  std::shared_ptr<Waiter> take_next();
  void begin(const std::shared_ptr<Waiter>& waiter);
  void end(const std::string& target);

  std::mutex mutex_;  // guards the members below
  std::size_t free_;
  bool is_stopped_ = false;
  std::set<std::string> running_;  // targets of the running tasks
  FairQueue<std::shared_ptr<Waiter>> waiting_;
};

}  // namespace vitrine::server
