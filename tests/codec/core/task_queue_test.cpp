// SPDX-License-Identifier: Apache-2.0
#include "codec/core/task_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "support/product_names.h"

namespace vitrine::test {
namespace {

TEST(TaskQueue, RunsEachTaskOnce) {
  for (const unsigned threads : {1u, 2u, 3u}) {
    std::vector<std::atomic<int>> runs(100);
    TaskQueue queue(threads, 5);
    for (std::atomic<int>& count : runs) {
      queue.make_room(1);
      queue.add({[&count] { ++count; }, 1});
    }
    queue.finish();
    for (const std::atomic<int>& count : runs)
      EXPECT_EQ(count, 1);
  }
}

TEST(TaskQueue, OneThreadRunsATaskWhenItIsAdded) {
  TaskQueue queue(1, 1);
  bool has_run = false;
  queue.add({[&] { has_run = true; }, 1});
  EXPECT_TRUE(has_run);
}

TEST(TaskQueue, TwoThreadsRunTwoTasksAtTheSameTime) {
  TaskQueue queue(2, 2);
  std::atomic<int> begun{0};
  const auto meet = [&] {
    ++begun;
    while (begun < 2)
      std::this_thread::yield();
  };
  queue.add({meet, 1});
  queue.add({meet, 1});
  queue.finish();
  EXPECT_EQ(begun, 2);
}

TEST(TaskQueue, MakingRoomRunsTheTasksThatWaitAndWaitsForThoseThatRun) {
  TaskQueue queue(2, 10);
  std::atomic<bool> is_released{false};
  std::atomic<int> ended{0};
  queue.add({[&] {
               while (!is_released)
                 std::this_thread::yield();
               ++ended;
             },
             6});
  queue.add({[&] { is_released = true, ++ended; }, 4});
  queue.make_room(10);
  EXPECT_EQ(ended, 2);
}

TEST(TaskQueue, ATaskHeavierThanAllMayRunAlone) {
  TaskQueue queue(2, 10);
  std::atomic<bool> has_run{false};
  queue.add({[] {}, 3});
  queue.make_room(100);
  queue.add({[&] { has_run = true; }, 100});
  queue.finish();
  EXPECT_TRUE(has_run);
}

TEST(TaskQueue, FinishRethrowsATasksExceptionOnceAllHaveEnded) {
  for (const unsigned threads : {1u, 2u}) {
    TaskQueue queue(threads, 10);
    std::atomic<int> runs{0};
    queue.add({[] { throw std::runtime_error("a task"); }, 1});
    queue.add({[&] { ++runs; }, 1});
    EXPECT_THROW(queue.finish(), std::runtime_error);
    EXPECT_EQ(runs, 1);
  }
}

TEST(TaskQueue, DroppingAQueueWaitsForTheTasksThatRun) {
  std::atomic<bool> has_begun{false}, is_dropped{false}, has_ended{false};
  {
    TaskQueue queue(2, 10);
    queue.add({[&] {
                 has_begun = true;
                 while (!is_dropped)
                   std::this_thread::yield();
                 has_ended = true;
               },
               1});
    while (!has_begun)
      std::this_thread::yield();
    is_dropped = true;
  }
  EXPECT_TRUE(has_ended);
}

}  // namespace
}  // namespace vitrine::test
