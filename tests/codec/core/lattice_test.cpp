// SPDX-License-Identifier: Apache-2.0
#include "codec/core/lattice.h"

#include <gtest/gtest.h>

#include "codec/core/limits.h"
#include "support/random_mesh.h"

namespace vitrine {
namespace {

TEST(Lattice, LatticePointsComeBackAtEveryNumberOfBits) {
  for (int bits = kMinBits; bits <= kMaxBits; ++bits) {
    const std::vector<Vec3> box = {{-3.1, 7.25, 1e-3}, {18.7, 9.5, 4.125}};
    const Lattice lattice = fit_lattice(box, bits);
    test::Dice dice(static_cast<std::uint64_t>(bits));
    const std::int32_t top = (1 << bits) - 1;
    for (int i = 0; i < 1000; ++i) {
      const Vec3i p = {dice.between(0, top), dice.between(0, top), dice.between(0, top)};
      ASSERT_EQ(lattice.to_lattice(lattice.to_model(p)), p);
    }
  }
}

TEST(Lattice, RoundsHalfUpAndClampsToTheGrid) {
  const Lattice lattice{.origin = {0, 0, 0}, .step = 1, .bits = 10};
  EXPECT_EQ(lattice.to_lattice({0.5, 1.4999, 2.5}), (Vec3i{1, 1, 3}));
  EXPECT_EQ(lattice.to_lattice({-7, 5000, 1023.4}), (Vec3i{0, 1023, 1023}));
}

TEST(Lattice, APointHasAStepToo) {
  const std::vector<Vec3> same = {{2, 2, 2}, {2, 2, 2}};
  const Lattice lattice = fit_lattice(same, 12);
  EXPECT_EQ(lattice.step, 1);
  EXPECT_EQ(lattice.to_lattice({2, 2, 2}), Vec3i{});
}

}  // namespace
}  // namespace vitrine
