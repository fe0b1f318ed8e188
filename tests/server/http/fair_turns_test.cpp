// SPDX-License-Identifier: Apache-2.0
#include "server/http/fair_turns.h"

#include <gtest/gtest.h>

#include <map>

namespace vitrine::server {
namespace {

class Turns : public ::testing::Test {
 private:
  asio::io_context io_;  // destroyed last, because tasks that wait have timers

 protected:
  // Waits for a turn of the owner, the first letter of `task`. The turn lasts until end(task).
  void begin(const std::string& task, const std::string& target = "") {
    auto in_turn = [this, task, target]() -> asio::awaitable<void> {
      running_[task] = co_await turns->wait(task.substr(0, 1), target);
      order += task + " ";
    };
    asio::co_spawn(asio::make_strand(io_), std::move(in_turn), asio::detached);
    run_what_is_ready();
  }
  void end(const std::string& task) {
    running_.erase(task);
    run_what_is_ready();
  }

  std::shared_ptr<FairTurns> turns;
  std::string order;  // the tasks in the order in which their turns began

 private:
  void run_what_is_ready() {
    while (io_.poll() > 0) {
    }
    io_.restart();
  }

  std::map<std::string, FairTurns::Turn> running_;
};

TEST_F(Turns, AnOwnerHasAtMostItsShareAndOthersHaveTheRest) {
  turns = std::make_shared<FairTurns>(4, 2);
  for (const char* task : {"a1", "a2", "a3", "a4"})
    begin(task);
  EXPECT_EQ(order, "a1 a2 ");
  for (const char* task : {"b1", "c1", "d1"})
    begin(task);
  EXPECT_EQ(order, "a1 a2 b1 c1 ");
  end("a1");
  EXPECT_EQ(order, "a1 a2 b1 c1 d1 ");
  end("b1");
  EXPECT_EQ(order, "a1 a2 b1 c1 d1 a3 ");
  end("c1");
  EXPECT_EQ(order, "a1 a2 b1 c1 d1 a3 ");
  end("a3");
  EXPECT_EQ(order, "a1 a2 b1 c1 d1 a3 a4 ");
}

TEST_F(Turns, TasksBeyondAShareTakeTurnsWithThoseOfOtherOwners) {
  turns = std::make_shared<FairTurns>(1, 1);
  for (const char* task : {"a1", "a2", "a3", "b1", "b2", "c1"})
    begin(task);
  for (const char* task : {"a1", "b1", "c1", "a2", "b2", "a3"})
    end(task);
  EXPECT_EQ(order, "a1 b1 c1 a2 b2 a3 ");
}

TEST_F(Turns, OnlyTasksWithEqualTargetsRunOneAfterTheOther) {
  turns = std::make_shared<FairTurns>(8);
  begin("a1", "x");
  begin("b1", "x");
  begin("a2", "y");
  begin("a3");
  begin("a4");
  EXPECT_EQ(order, "a1 a2 a3 a4 ");
  end("a1");
  EXPECT_EQ(order, "a1 a2 a3 a4 b1 ");
}

TEST_F(Turns, NoneBeginsAfterAStop) {
  turns = std::make_shared<FairTurns>(1);
  begin("a1");
  begin("a2");
  turns->stop();
  end("a1");
  EXPECT_EQ(order, "a1 ");
}

}  // namespace
}  // namespace vitrine::server
