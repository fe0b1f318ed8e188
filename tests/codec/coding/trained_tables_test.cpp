// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/trained_tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

namespace vitrine::trained {
namespace {

std::vector<double> by_the_standard_library(const char* text) {
  std::vector<double> numbers;
  for (char* end = nullptr; *text != 0; text = end + 1)
    numbers.push_back(std::strtod(text, &end));
  return numbers;
}

std::vector<double> loaded(const char* text, std::size_t count) {
  std::vector<double> numbers(count);
  load(text, numbers);
  return numbers;
}

// The tables are part of the format, so each number must be exact to the last bit.
TEST(TrainedTables, EachNumberIsTheNearestDouble) {
  for (const char* table : {kCutWeights, kTangentialWeights, kNormalWeights, kEvidence,
                            "0 1 -2.44374 .0386 7.91717e-18 -1.38783e-05 "}) {
    const std::vector<double> expected = by_the_standard_library(table);
    EXPECT_EQ(loaded(table, expected.size()), expected) << table;
  }
}

TEST(TrainedTables, EachStepIsAProbabilityOfTwelveBits) {
  constexpr int kEven = kHalf;
  for (int step = 1; step < 2 * kEven; ++step) {
    const std::uint8_t packed[] = {static_cast<std::uint8_t>(step), 5};
    AdaptiveBit bit;
    load(packed, {&bit, 1});
    const double one = 4096 / (1 + std::exp((kEven - step) / 8.0));
    EXPECT_EQ(bit.one >> 4, std::max(static_cast<int>(one), 1)) << step;
    EXPECT_EQ(bit.one & 15, 8) << step;
    EXPECT_EQ(bit.seen, 6) << step;
  }
}

}  // namespace
}  // namespace vitrine::trained
