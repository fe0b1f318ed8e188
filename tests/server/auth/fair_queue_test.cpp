// SPDX-License-Identifier: Apache-2.0
#include "server/auth/fair_queue.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

constexpr auto kAny = [](const std::string&) { return true; };

std::string drain(FairQueue<std::string>& queue) {
  std::string order;
  while (const auto item = queue.take(kAny))
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
  EXPECT_EQ(queue.take(kAny), "a1");
  queue.push("b", "b1");
  EXPECT_EQ(queue.take(kAny), "b1");
  queue.push("b", "b2");
  EXPECT_EQ(drain(queue), "a2 b2 a3 ");
}

TEST(FairQueue, ServingAloneGivesNoDebtAndNoCredit) {
  FairQueue<std::string> queue;
  for (int i = 0; i < 100; ++i) {
    queue.push("a", "a");
    EXPECT_EQ(queue.take(kAny), "a");
  }
  for (const char* item : {"a1", "a2"})
    queue.push("a", item);
  for (const char* item : {"b1", "b2"})
    queue.push("b", item);
  EXPECT_EQ(drain(queue), "b1 a1 b2 a2 ");
}

TEST(FairQueue, AnItemThatIsNotReadyKeepsItsPlace) {
  FairQueue<std::string> queue;
  for (const char* item : {"a1", "a2", "b1"})
    queue.push(std::string(1, item[0]), item);
  EXPECT_EQ(queue.take([](const std::string& item) { return item != "a1"; }), "b1");
  EXPECT_EQ(queue.take([](const std::string&) { return false; }), std::nullopt);
  EXPECT_EQ(drain(queue), "a1 a2 ");
}

}  // namespace
}  // namespace vitrine::server
