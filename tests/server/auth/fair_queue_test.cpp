// SPDX-License-Identifier: Apache-2.0
#include "server/auth/fair_queue.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

std::string drain(FairQueue<std::string>& queue) {
  std::string order;
  while (const auto item = queue.take())
    order += *item + " ";
  return order;
}

TEST(FairQueue, ServesOwnersInTurnAndEachInOrder) {
  FairQueue<std::string> queue;
  for (const char* item : {"a1", "a2", "a3", "a4", "b1", "c1", "b2"})
    queue.push(std::string(1, item[0]), item);
  EXPECT_EQ(drain(queue), "a1 b1 c1 a2 b2 a3 a4 ");
}

TEST(FairQueue, ANewOwnerIsNextButNotForeverFirst) {
  FairQueue<std::string> queue;
  for (const char* item : {"a1", "a2", "a3"})
    queue.push("a", item);
  EXPECT_EQ(queue.take(), "a1");
  queue.push("b", "b1");
  EXPECT_EQ(queue.take(), "b1");
  queue.push("b", "b2");
  EXPECT_EQ(drain(queue), "a2 b2 a3 ");
}

TEST(FairQueue, ServingAloneGivesNoDebtAndNoCredit) {
  FairQueue<std::string> queue;
  for (int i = 0; i < 100; ++i) {
    queue.push("a", "a");
    EXPECT_EQ(queue.take(), "a");
  }
  for (const char* item : {"a1", "a2"})
    queue.push("a", item);
  for (const char* item : {"b1", "b2"})
    queue.push("b", item);
  EXPECT_EQ(drain(queue), "b1 a1 b2 a2 ");
}

TEST(FairQueue, ItemsWithEqualTargetsLeaveOneAtATimeInTheSameOrder) {
  FairQueue<std::string> queue;
  for (const char* item : {"a1", "a2", "b1"})
    queue.push(std::string(1, item[0]), item, "x");
  queue.push("a", "a3", "y");
  queue.push("a", "a4");
  EXPECT_EQ(drain(queue), "a1 a3 a4 ");
  queue.push("c", "c1", "x");
  EXPECT_EQ(drain(queue), "");
  queue.finish("y");
  EXPECT_EQ(drain(queue), "");
  for (const char* item : {"b1", "a2", "c1"}) {
    queue.finish("x");
    EXPECT_EQ(drain(queue), std::string(item) + " ");
  }
  queue.finish("x");
  queue.push("a", "a5", "x");
  EXPECT_EQ(drain(queue), "a5 ");
}

TEST(FairQueue, BlockedItemsAreNotCheckedAgainUntilTheirTurn) {
  constexpr int kItems = 1000;
  FairQueue<int> queue;
  int taken = 0;
  for (int i = 0; i < kItems; ++i) {
    queue.push("a", i, "x");
    if (queue.take()) ++taken;
  }
  EXPECT_EQ(taken, 1);
  for (int i = 1; i < kItems; ++i) {
    queue.finish("x");
    EXPECT_EQ(queue.take(), i);
    EXPECT_EQ(queue.take(), std::nullopt);
  }
  EXPECT_LE(queue.checks(), 2u * kItems);
}

}  // namespace
}  // namespace vitrine::server
