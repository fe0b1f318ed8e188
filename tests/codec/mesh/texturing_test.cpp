// SPDX-License-Identifier: Apache-2.0
#include "codec/mesh/texturing.h"

#include <gtest/gtest.h>

#include <numbers>

namespace vitrine::test {
namespace {

TEST(TextureTransform, ScalesThenTurnsThenShifts) {
  EXPECT_EQ(TextureTransform{}.at(0.25, 0.75), (std::array{0.25, 0.75}));
  const TextureTransform transform{
      .offset = {0.5, 3}, .scale = {2, 4}, .rotation = std::numbers::pi / 2};
  const auto [u, v] = transform.at(0.25, 0.75);
  EXPECT_DOUBLE_EQ(u, 0.5 + 4 * 0.75);
  EXPECT_DOUBLE_EQ(v, 3 - 2 * 0.25);
}

}  // namespace
}  // namespace vitrine::test
