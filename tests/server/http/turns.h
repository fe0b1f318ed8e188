// SPDX-License-Identifier: Apache-2.0
// A fixture with tasks that wait for turns, on one thread.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "server/http/fair_turns.h"

namespace vitrine::test {

class Turns : public ::testing::Test {
 private:
  server::asio::io_context io_;  // destroyed last, because waiting tasks have timers that use it

 protected:
  // Lets `task` wait for a turn. The first letter of its name is the owner. The turn lasts until
  // end(task).
  void begin(const std::string& task, const std::string& target = "") {
    auto in_turn = [this, task, target]() -> server::asio::awaitable<void> {
      running_[task] = co_await turns->wait(task.substr(0, 1), target);
      order += task + " ";
    };
    server::asio::co_spawn(server::asio::make_strand(io_), std::move(in_turn),
                           server::asio::detached);
    run_what_is_ready();
  }
  // Like begin(), but the turn ends at once and is only counted.
  void pass(const std::string& owner, const std::string& target) {
    auto in_turn = [this, owner, target]() -> server::asio::awaitable<void> {
      co_await turns->wait(owner, target);
      ++passed;
    };
    server::asio::co_spawn(server::asio::make_strand(io_), std::move(in_turn),
                           server::asio::detached);
    run_what_is_ready();
  }
  void end(const std::string& task) {
    end_without_running_others(task);
    run_what_is_ready();
  }
  void end_without_running_others(const std::string& task) { running_.erase(task); }
  void wait_for_the_turn_of(const std::string& task) {
    while (!running_.contains(task) && io_.run_one() > 0) {
    }
    EXPECT_TRUE(running_.contains(task)) << task;
  }

  std::shared_ptr<server::FairTurns> turns;
  std::string order;  // the tasks in the order in which their turns began
  int passed = 0;     // number of turns of pass()

 private:
  void run_what_is_ready() {
    while (io_.poll() > 0) {
    }
    io_.restart();
  }

  std::map<std::string, server::FairTurns::Turn> running_;
};

}  // namespace vitrine::test
