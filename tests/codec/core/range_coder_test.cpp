// SPDX-License-Identifier: Apache-2.0
#include "codec/core/range_coder.h"

#include <gtest/gtest.h>

#include "support/random_mesh.h"

namespace vitrine {
namespace {

using test::Dice;

struct Decision {
  std::uint32_t value;
  int model;  // index of an adaptive bit; if negative, minus the number of raw bits
};

std::vector<std::uint8_t> encode(const std::vector<Decision>& decisions) {
  RangeEncoder coder;
  std::array<AdaptiveBit, 8> models;
  for (const Decision& d : decisions) {
    if (d.model < 0) {
      coder.raw(d.value, -d.model);
    } else {
      coder.bit(models[static_cast<std::size_t>(d.model)], static_cast<int>(d.value));
    }
  }
  return coder.finish();
}

void expect_decodes(const std::vector<Decision>& decisions) {
  const auto bytes = encode(decisions);
  RangeDecoder coder(bytes);
  std::array<AdaptiveBit, 8> models;
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    const Decision& d = decisions[i];
    const std::uint32_t got =
        d.model < 0
            ? coder.raw(0, -d.model)
            : static_cast<std::uint32_t>(coder.bit(models[static_cast<std::size_t>(d.model)]));
    ASSERT_EQ(got, d.value) << "decision " << i << " of " << decisions.size();
  }
}

TEST(RangeCoder, RandomDecisionsComeBack) {
  const std::uint64_t count = 5'000;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    const std::uint32_t odds = 1 + dice.below(300);
    std::vector<Decision> decisions;
    for (std::uint32_t n = dice.below(400); n > 0; --n) {
      const int raw = dice.between(1, 20);
      dice.one_in(5) ? decisions.push_back({dice.below(1u << raw), -raw})
                     : decisions.push_back({dice.one_in(odds) ? 1u : 0u, dice.between(0, 7)});
    }
    ASSERT_NO_FATAL_FAILURE(expect_decodes(decisions));
  }
}

// Raw zero bits leave `low` just below a carry. The encoder then holds a long run of pending 0xFF
// bytes. The last decision decides whether a carry passes through this run.
TEST(RangeCoder, LongRunsOfPendingBytesCarryOrNot) {
  for (int run = 0; run < 300; ++run) {
    for (const std::uint32_t last : {0u, 1u}) {
      for (int before = 0; before < 10; ++before) {
        std::vector<Decision> decisions(static_cast<std::size_t>(before), {1, -1});
        decisions.insert(decisions.end(), static_cast<std::size_t>(8 * run), {0, -1});
        decisions.push_back({last, 0});
        decisions.push_back({1 - last, 1});
        decisions.push_back({last, -1});
        ASSERT_NO_FATAL_FAILURE(expect_decodes(decisions)) << run << " bytes, last " << last;
      }
    }
  }
}

TEST(RangeCoder, AStreamOfLikelyOnesIsEmptyAndReadsAsOnes) {
  EXPECT_TRUE(encode(std::vector<Decision>(1000, {1, 0})).empty());
  RangeDecoder nothing({});
  AdaptiveBit model;
  for (int i = 0; i < 1000; ++i)
    EXPECT_EQ(nothing.bit(model), 1);
}

TEST(AdaptiveBit, StaysInsideItsBoundsAndFollowsWhatItSees) {
  AdaptiveBit ones, zeros;
  for (int i = 0; i < 5000; ++i) {
    ones.update(1);
    zeros.update(0);
    ASSERT_GE(ones.one, 32768);
    ASSERT_LE(ones.one, 65535 - 24);
    ASSERT_GE(zeros.one, 23);
    ASSERT_LE(zeros.one, 32768);
  }
  EXPECT_GT(ones.one, 65000);
  EXPECT_LT(zeros.one, 500);
}

// Expects the values that FORMAT.md lists.
TEST(AdaptiveBit, MovesAsTheFormatSays) {
  AdaptiveBit bit;
  bit.update(1);
  EXPECT_EQ(bit.one, 54596);
  bit.update(0);
  EXPECT_EQ(bit.one, 32767);
  bit.update(1);
  EXPECT_EQ(bit.one, 42122);
}

}  // namespace
}  // namespace vitrine
