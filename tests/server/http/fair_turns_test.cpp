// SPDX-License-Identifier: Apache-2.0
#include "turns.h"

namespace vitrine::server {
namespace {

using test::Turns;

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

TEST_F(Turns, ManyTasksWithEqualTargetsTakeTheirTurns) {
  turns = std::make_shared<FairTurns>(8);
  begin("a", "x");
  for (int i = 0; i < 1000; ++i)
    pass("b", "x");
  EXPECT_EQ(order, "a ");
  end("a");
  EXPECT_EQ(passed, 1000);
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
