// SPDX-License-Identifier: Apache-2.0
// Limits how many tasks run at the same time, in total and per owner. The owners take turns. An
// owner with many tasks therefore delays every other owner by only one task.
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "server/auth/fair_queue.h"
#include "server/http/beast.h"

namespace vitrine::server {

// Thread-safe. Must be owned by a shared pointer, because each turn keeps the object alive.
class FairTurns : public std::enable_shared_from_this<FairTurns> {
 public:
  // At most `at_a_time` tasks run at the same time, and at most `per_owner` of each owner.
  explicit FairTurns(std::size_t at_a_time, std::size_t per_owner = SIZE_MAX)
      : per_owner_(per_owner), free_(at_a_time) {}

  // A turn: the permission to run one task. It lasts until its last copy is destroyed.
  using Turn = std::shared_ptr<const void>;
  // Waits for a turn of `owner`. Tasks with equal targets run one after the other, unless the
  // target is empty. Must be called on a strand.
  asio::awaitable<Turn> wait(std::string owner, std::string target = "");

  void stop();  // no turn begins after this call

 private:
  // A task that waits or runs. The destructor ends the task's turn, if the turn has begun. As
  // destructors must not throw, end() and the functions that it calls work even if memory runs out.
  struct Task {
    Task(std::string its_owner, std::string its_target)
        : owner(std::move(its_owner)), target(std::move(its_target)) {}
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;
    ~Task();

    const std::string owner, target;
    std::shared_ptr<FairTurns> turns;  // null until the turn begins
  };
  struct Waiter {
    asio::steady_timer timer;
    const std::shared_ptr<Task> task;
  };
  struct OwnersTasks {
    std::size_t admitted = 0;  // number of tasks that run or are in `waiting_`
    // The other tasks. They are not in `waiting_`, so that take_next() need not skip them.
    std::list<std::shared_ptr<Waiter>> further;
  };
  void push(const std::shared_ptr<Waiter>& waiter);
  // Begins the waiter's turn if one is free. Returns whether the turn has begun. Must be called on
  // the waiter's strand.
  bool begins(const std::shared_ptr<Waiter>& waiter);
  // Moves as many of the owner's tasks to `waiting_` as its share allows, or fewer if memory runs
  // out. The caller must hold mutex_.
  void admit(const std::string& owner, OwnersTasks& tasks);
  // Begins as many turns as are free, and wakes the waiters except `here`. `here` is null, or the
  // waiter on whose strand the caller runs. The caller must not hold mutex_.
  void give_turns(const std::shared_ptr<Waiter>& here);
  // Removes the next waiter from the queue and begins its turn. Returns null if no turn is free, or
  // no waiter can begin.
  std::shared_ptr<Waiter> take_next();
  void end(const Task& task);

  const std::size_t per_owner_;
  std::mutex mutex_;  // guards the members below
  std::size_t free_;
  bool is_stopped_ = false;
  std::map<std::string, OwnersTasks> tasks_of_;
  FairQueue<std::shared_ptr<Waiter>> waiting_;
};

}  // namespace vitrine::server
