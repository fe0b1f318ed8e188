// SPDX-License-Identifier: Apache-2.0
#include "codec/format/lattice_attributes.h"

#include <gtest/gtest.h>

#include "codec/format/placement.h"
#include "support/random_mesh.h"

namespace vitrine {
namespace {

TEST(Colour, EveryColourComesBack) {
  for (int rgb = 0; rgb < 1 << 24; ++rgb) {
    const Colour c = {static_cast<std::uint8_t>(rgb), static_cast<std::uint8_t>(rgb >> 8),
                      static_cast<std::uint8_t>(rgb >> 16)};
    ASSERT_EQ(from_ycocg(to_ycocg(c)), c);
  }
}

TEST(Colour, MergedColoursSplitAgain) {
  test::Dice dice(1);
  const auto random = [&] {
    return Vec3i{dice.between(-600, 600), dice.between(-600, 600), dice.between(-600, 600)};
  };
  for (int i = 0; i < 100'000; ++i) {
    const Vec3i c1 = random(), c2 = random();
    const SplitPair back = unmerge(merge_values(c1, c2), c1 - c2, Vec3i{});
    ASSERT_EQ(back.v1, c1);
    ASSERT_EQ(back.v2, c2);
  }
}

}  // namespace
}  // namespace vitrine
