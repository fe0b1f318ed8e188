// SPDX-License-Identifier: Apache-2.0
#include "codec/appearance/views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace vitrine {
namespace {

TEST(Views, EachDirectionIsAsFarFromItsFiveNeighboursAsOthers) {
  const auto directions = view_directions();
  for (const Vec3& a : directions) {
    const auto at_cosine = [&](double cosine) {
      return std::ranges::count_if(directions, [&](const Vec3& b) {
        return std::abs(dot(a, b) / (length(a) * length(b)) - cosine) < 1e-9;
      });
    };
    EXPECT_EQ(at_cosine(1 / std::sqrt(5)), 5);
    EXPECT_EQ(at_cosine(-1 / std::sqrt(5)), 5);
    EXPECT_EQ(at_cosine(-1), 1);
  }
}

TEST(Views, TheBoundingSphereTouchesTheMargin) {
  const TriangleMesh mesh{.positions = {{10, 0, 0}, {16, 8, 0}, {10, 8, 0}, {99, 99, 99}},
                          .faces = {{0, 1, 2}},  // no face uses the last vertex
                          .attributes = {}};
  const auto views = views_around(mesh);
  ASSERT_TRUE(views.has_value());
  for (const Framing& view : *views) {
    EXPECT_EQ(view.centre, (Vec3{13, 4, 0}));
    EXPECT_DOUBLE_EQ(view.pixel * (512 - 16), 10);
    EXPECT_EQ(view.width, 512u);
    EXPECT_EQ(view.height, 512u);
  }
}

TEST(Views, APointHasNoViews) {
  const TriangleMesh point{.positions = {{1, 2, 3}}, .faces = {{0, 0, 0}}, .attributes = {}};
  EXPECT_FALSE(views_around(point).has_value());
  EXPECT_FALSE(views_around({}).has_value());
}

}  // namespace
}  // namespace vitrine
