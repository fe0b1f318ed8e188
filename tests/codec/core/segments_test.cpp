// SPDX-License-Identifier: Apache-2.0
#include "codec/core/segments.h"

#include <gtest/gtest.h>

#include <numeric>

namespace vitrine {
namespace {

constexpr std::size_t kMany = 3 * Segments<int>::kBlock + 7;

Segments<int> counted(std::size_t size) {
  Segments<int> segments;
  for (std::size_t i = 0; i < size; ++i)
    segments.push_back(static_cast<int>(i));
  return segments;
}

TEST(Segments, HoldWhatIsAppended) {
  std::vector<int> expected(kMany);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(counted(kMany).flat(), expected);
  EXPECT_TRUE(counted(0).empty());
}

TEST(Segments, GrowingMovesNothing) {
  Segments<int> segments = counted(1);
  const int* first = &segments[0];
  segments.resize(kMany, 5);
  EXPECT_EQ(&segments[0], first);
  EXPECT_EQ(segments[0], 0);
  EXPECT_EQ(segments[kMany - 1], 5);
}

TEST(Segments, WhatWasMovedFromIsEmptyAndGrowsAnew) {
  Segments<int> from = counted(3);
  Segments<int> to = std::move(from);
  from = counted(1);  // NOLINT(bugprone-use-after-move)
  from = std::move(to);
  EXPECT_EQ(from.flat(), (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(to.empty());  // NOLINT(bugprone-use-after-move)
  to.push_back(4);
  EXPECT_EQ(to.flat(), std::vector<int>{4});
}

TEST(Segments, WhatWasTakenOffIsFilledAnew) {
  Segments<int> segments = counted(kMany);
  segments.resize(2, 0);
  segments.pop_back();
  segments.resize(3, 9);
  EXPECT_EQ(segments.flat(), (std::vector<int>{0, 9, 9}));
}

}  // namespace
}  // namespace vitrine
