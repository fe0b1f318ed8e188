// SPDX-License-Identifier: Apache-2.0
#include "codec/core/parallel.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "support/product_names.h"

namespace vitrine::test {
namespace {

TEST(ForEachIndex, CallsForEachIndexOnce) {
  for (const unsigned threads : {1u, 2u, 3u, 7u}) {
    for (const std::size_t count : {0u, 1u, 2u, 1000u}) {
      std::vector<int> calls(count, 0);
      for_each_index(threads, count, [&](std::size_t i) { ++calls[i]; });
      EXPECT_EQ(calls, std::vector<int>(count, 1));
    }
  }
}

TEST(ForEachIndex, CallsRunAtTheSameTime) {
  std::atomic<int> begun{0};
  std::array<std::thread::id, 2> id;
  for_each_index(2, 2, [&](std::size_t i) {
    id[i] = std::this_thread::get_id();
    ++begun;
    while (begun < 2)
      std::this_thread::yield();
  });
  EXPECT_NE(id[0], id[1]);
}

TEST(ForEachIndex, AThreadAloneIsTheCallersInOrder) {
  std::vector<std::size_t> seen, expected(10);
  std::iota(expected.begin(), expected.end(), 0u);
  const auto caller = std::this_thread::get_id();
  for_each_index(1, expected.size(), [&](std::size_t i) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    seen.push_back(i);
  });
  EXPECT_EQ(seen, expected);
}

TEST(ForEachIndex, AnExceptionReachesTheCaller) {
  for (const unsigned threads : {1u, 3u}) {
    EXPECT_THROW(for_each_index(threads, 100,
                                [](std::size_t i) {
                                  if (i == 50) throw std::runtime_error("50");
                                }),
                 std::runtime_error);
  }
}

}  // namespace
}  // namespace vitrine::test
