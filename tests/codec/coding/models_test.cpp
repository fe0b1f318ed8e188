// SPDX-License-Identifier: Apache-2.0
// Tests the entropy models alone. The decoder must return the encoded values, even if the model
// predicts absurd values.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "codec/coding/cut_model.h"
#include "codec/coding/displacement_model.h"
#include "codec/coding/flag_model.h"
#include "codec/coding/residual_coder.h"
#include "support/random_mesh.h"

namespace vitrine {
namespace {

using test::Dice;

double random_double(Dice& dice, double bound) {
  return bound * (static_cast<double>(dice.below(2'000'001)) / 1e6 - 1);
}

struct Residual {
  std::int32_t value;
  double centre, width;
};

TEST(ResidualCoder, ValuesComeBackHoweverWrongTheExpectation) {
  Dice dice(1);
  std::vector<Residual> residuals;
  for (int i = 0; i < 20'000; ++i) {
    const double bound = static_cast<double>(1 << dice.below(20));
    residuals.push_back({static_cast<std::int32_t>(random_double(dice, bound)),
                         random_double(dice, dice.one_in(50) ? 1e9 : bound),
                         std::fabs(random_double(dice, bound)) + 1e-3});
  }
  RangeEncoder encoder;
  ResidualCoder in;
  for (const Residual& r : residuals)
    in.code(encoder, r.value, r.centre, r.width);
  const auto bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  ResidualCoder out;
  for (const Residual& r : residuals)
    ASSERT_EQ(out.code(decoder, 0, r.centre, r.width), r.value);
}

RingGeometry random_ring(Dice& dice) {
  RingGeometry ring;
  ring.size = static_cast<std::uint32_t>(dice.between(2, kMaxSplitValence));
  double sum = 0;
  for (std::uint32_t k = 0; k < ring.size; ++k) {
    ring.valence[k] = static_cast<std::int8_t>(dice.between(3, 100));
    ring.is_virtual[k] = dice.one_in(8);
    ring.place(k, {});
    if (ring.is_virtual[k]) continue;
    const double bound = dice.one_in(3) ? 0 : 500'000;
    ring.place(k,
               {std::round(random_double(dice, bound)), std::round(random_double(dice, bound)), 0});
    sum += length(ring.at(k));
  }
  ring.scale = std::max(sum / ring.size, 0.5);
  return ring;
}

TEST(CutModel, EveryCutOfAnyRingComesBack) {
  Dice dice(2);
  std::vector<std::pair<RingGeometry, RingCut>> cuts;
  for (int i = 0; i < 500; ++i) {
    const RingGeometry ring = random_ring(dice);
    const std::uint32_t a = dice.below(ring.size),
                        b = (a + 1 + dice.below(ring.size - 1)) % ring.size;
    cuts.emplace_back(ring, RingCut{std::min(a, b), std::max(a, b)});
  }
  RangeEncoder encoder;
  CutModel in;
  for (const auto& [ring, cut] : cuts)
    in.code(encoder, ring, cut);
  const auto bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  CutModel out;
  for (const auto& [ring, cut] : cuts) {
    const RingCut got = out.code(decoder, ring, {});
    ASSERT_EQ(got.i, cut.i);
    ASSERT_EQ(got.j, cut.j);
  }
}

SplitSurroundings random_surroundings(Dice& dice) {
  SplitSurroundings s;
  const double bound = dice.one_in(2) ? 400'000 : 10;
  const Vec3 one = {random_double(dice, bound), random_double(dice, bound),
                    random_double(dice, bound)};
  // Makes many features equal, so that the model's regression has no unique solution.
  for (Vec3& f : s.features)
    f = dice.one_in(3) ? Vec3{random_double(dice, bound), 0, random_double(dice, bound)} : one;
  s.normal = dice.one_in(3) ? Vec3{} : Vec3{0, 0.6, 0.8};
  s.scale = std::max(0.5, std::fabs(random_double(dice, bound)));
  s.kind = dice.one_in(2) ? 1 : 0;
  for (std::uint8_t& clue : s.clues)
    clue = static_cast<std::uint8_t>(dice.between(0, SplitSurroundings::kLevels - 1));
  return s;
}

TEST(DisplacementModel, AnyDisplacementComesBackInAnySurroundings) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Dice dice(seed);
    std::vector<std::pair<SplitSurroundings, Vec3i>> splits;
    const std::int32_t bound = dice.one_in(2) ? 500'000 : 8;
    for (int i = 0; i < 400; ++i) {
      const SplitSurroundings s = random_surroundings(dice);
      splits.emplace_back(s, Vec3i{dice.between(-bound, bound), dice.between(-bound, bound), 0});
    }
    RangeEncoder encoder;
    DisplacementModel in;
    SplitError encoded_error, decoded_error;
    for (const auto& [s, d] : splits)
      in.code(encoder, s, d, encoded_error);
    const auto bytes = encoder.finish();
    RangeDecoder decoder(bytes);
    DisplacementModel out;
    for (const auto& [s, d] : splits)
      ASSERT_EQ(out.code(decoder, s, {}, decoded_error), d) << "seed " << seed;
    ASSERT_EQ(encoded_error.all, decoded_error.all);
    ASSERT_EQ(encoded_error.normal, decoded_error.normal);
  }
}

// Expects that the first update of each initial state does not overflow its 32-bit product. States
// reached by coding bits never overflow it, but a wrong initial state could.
template <class Model>
void expect_safe_starts(const Model& model) {
  for (const AdaptiveBit& start : model.bits()) {
    for (const int bit : {0, 1}) {
      AdaptiveBit moved = start;
      moved.update(bit);
      const double target = bit != 0 ? 65535 - 24 : 24;
      const double step = 131072 / (2 * start.seen + 3);
      ASSERT_LT(std::fabs(target - start.one) * step, 2147483648.0);
      ASSERT_NEAR(moved.one, start.one + (target - start.one) * step / 65536, 1.0);
    }
  }
}

TEST(TrainedTables, EveryStartUpdatesWithoutOverflow) {
  expect_safe_starts(FlagModel());
  expect_safe_starts(CutModel());
  expect_safe_starts(ResidualCoder());
}

}  // namespace
}  // namespace vitrine
