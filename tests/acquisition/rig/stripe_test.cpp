// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "acquisition/rig_optics/solid.h"
#include "support/rig_scenes.h"

namespace vitrine::acquisition::rig::test {
namespace {

// Returns the point at height z at which the middle of the laser sheet cuts a surface, with the
// table at 0 degrees.
using Cut = std::function<std::optional<Vec3>(const LaserSheet&, double z)>;

struct Deviation {
  double worst = 0, mean = 0;
  int rows = 0;
};

// Compares the centre of the rendered stripe with the projected cut in each row. Returns the
// deviation in pixels.
Deviation deviation(const Optics& optics, const Subject& subject, const Cut& cut) {
  Renderer renderer(optics, &subject, ideal());
  const Exposure bright{.us = 8000};  // a longer exposure makes rounding matter less
  const Frame lit = renderer.take({at(0, true), bright});
  const Frame dark = renderer.take({at(0, false), bright});
  Deviation found;
  for (double z = 5; z < 75; z += 0.7) {
    const auto point = cut(optics.laser, z);
    const auto pixel = point ? project(optics.camera, *point) : std::nullopt;
    if (!pixel) continue;
    // The expected centre in this row: interpolates between the cut at height `z` and the cut
    // slightly higher.
    const int v = static_cast<int>(std::lround(pixel->v));
    const auto beside = project(optics.camera, *cut(optics.laser, z + 0.1));
    const double u = pixel->u + (v - pixel->v) * (beside->u - pixel->u) / (beside->v - pixel->v);
    const auto measured = centre(lit, dark, v, u);
    if (!measured) continue;
    found.worst = std::max(found.worst, std::abs(*measured - u));
    found.mean += *measured - u;
    ++found.rows;
  }
  found.mean /= std::max(found.rows, 1);
  return found;
}

double sheet_y(const LaserSheet& laser, double z) {
  return (laser.offset - laser.normal.z * z) / laser.normal.y;
}

TEST(Stripe, OnAWallItIsWhereTheSheetCutsTheWall) {
  for (const double azimuth : {-10.0, 30.0, -50.0}) {
    const Optics optics = optics_of(3);
    const Vec3 middle{15, 0, 40};
    const Solid solid = matt(wall(middle, azimuth, 90));
    const double slope = std::tan(azimuth * std::numbers::pi / 180);
    const Deviation found = deviation(optics, solid, [&](const LaserSheet& laser, double z) {
      const double y = sheet_y(laser, z);
      return std::optional<Vec3>({middle.x - y * slope, y, z});
    });
    EXPECT_GT(found.rows, 90);
    EXPECT_LT(found.worst, 0.05) << azimuth;
    EXPECT_LT(std::abs(found.mean), 0.01) << azimuth;
  }
}

TEST(Stripe, OnABallItIsWhereTheSheetCutsTheBall) {
  const Optics optics = optics_of(4);
  const Vec3 middle{3, 1, 40};
  constexpr double kRadius = 34;
  const Solid solid = matt(ball(middle, kRadius, 900));
  const Deviation found =
      deviation(optics, solid, [&](const LaserSheet& laser, double z) -> std::optional<Vec3> {
        const double y = sheet_y(laser, z);
        const double rest =
            kRadius * kRadius - std::pow(z - middle.z, 2) - std::pow(y - middle.y, 2);
        if (rest < 200) return std::nullopt;  // near the poles, the cut runs almost along the rows
        return Vec3{middle.x + std::sqrt(rest), y, z};
      });
  EXPECT_GT(found.rows, 70);
  EXPECT_LT(found.worst, 0.05);
}

// Returns the sum of the grey levels that the laser adds to 17 pixels of a row. The one in their
// middle sees `point`.
double light_at(const Optics& optics, const Subject& subject, const Vec3& point,
                const Realism& realism = ideal(), Exposure exposure = {}) {
  Renderer renderer(optics, &subject, realism);
  const Frame lit = renderer.take({.setting = at(0, true), .exposure = exposure});
  const Frame dark = renderer.take({.setting = at(0, false), .exposure = exposure});
  const ImagePoint pixel = *project(optics.camera, point);
  double sum = 0;
  const int v = static_cast<int>(std::lround(pixel.v)), u = static_cast<int>(std::lround(pixel.u));
  for (int i = u - 8; i <= u + 8; ++i)
    sum += lit.row(v)[i] - dark.row(v)[i];
  return sum;
}

TEST(Stripe, WhatHidesAPointFromTheCameraHidesItsLight) {
  const Optics optics = optics_of(1);
  TriangleMesh mesh = wall({0, 0, 40}, -10, 80);
  const Vec3 point{0, sheet_y(optics.laser, 40), 40};
  EXPECT_GT(light_at(optics, matt(mesh), point), 200);
  const Vec3 before = point + (optics.camera.at - point) * 0.2;
  const TriangleMesh screen = wall(before, -27, 12);
  add_quad(mesh, screen.positions[0], screen.positions[1] - screen.positions[0],
           screen.positions[3] - screen.positions[0]);
  EXPECT_EQ(light_at(optics, matt(mesh), point), 0);
}

TEST(Stripe, WhatHidesAPointFromTheLaserLeavesItDark) {
  const Optics optics = optics_of(1);
  TriangleMesh mesh = wall({0, 0, 40}, -10, 80);
  const Vec3 point{0, sheet_y(optics.laser, 40), 40};
  const Vec3 before = point + (optics.laser.source - point) * 0.3;
  const TriangleMesh screen = wall(before, 0, 12);
  add_quad(mesh, screen.positions[0], screen.positions[1] - screen.positions[0],
           screen.positions[3] - screen.positions[0]);
  EXPECT_EQ(light_at(optics, matt(mesh), point), 0);
  const double elsewhere = light_at(optics, matt(mesh), {0, sheet_y(optics.laser, 10), 10});
  EXPECT_GT(elsewhere, 200);
}

TEST(Stripe, ASurfaceLitFromBehindIsDark) {
  const Optics optics = optics_of(1);
  const Vec3 point{0, sheet_y(optics.laser, 40), 40};
  // The front of this wall faces the camera, but not the laser.
  EXPECT_EQ(light_at(optics, matt(wall({0, 0, 40}, -100, 80)), point), 0);
}

TEST(Stripe, GlossAddsLightWhereItMirrorsTheLaserIntoTheCamera) {
  const Optics optics = optics_of(1);
  const Vec3 point{0, sheet_y(optics.laser, 40), 40};
  const auto unit = [](const Vec3& v) { return v * (1 / length(v)); };
  const Vec3 half = unit(unit(optics.laser.source - point) + unit(optics.camera.at - point));
  const TriangleMesh mesh = facet(point, half, 60);
  const Solid glossy(mesh, {.is_painted = false, .gloss = 0.25});
  EXPECT_GT(light_at(optics, glossy, point, ideal(), {.us = 1500}),
            1.1 * light_at(optics, matt(mesh), point, ideal(), {.us = 1500}));
}

// Appends to `rows` the sum of the stripe's light in each row of a wall. The wall is at `x` and
// faces the camera.
void add_rows(const Optics& optics, double x, std::vector<double>& rows) {
  const Solid solid(wall({x, 0, 40}, -10, 80), {.is_painted = true, .gloss = 0});
  Renderer renderer(optics, &solid, ideal());
  const Frame lit = renderer.take({at(0, true)}), dark = renderer.take({at(0, false)});
  for (double z = 10; z < 70; z += 0.25) {
    const ImagePoint pixel = *project(optics.camera, {x, sheet_y(optics.laser, z), z});
    double sum = 0;
    const int u = static_cast<int>(std::lround(pixel.u));
    for (int i = u - 8; i <= u + 8; ++i) {
      const int v = static_cast<int>(std::lround(pixel.v));
      sum += lit.row(v)[i] - dark.row(v)[i];
    }
    rows.push_back(sum);
  }
}

TEST(Stripe, PaintOfAnotherAlbedoHasSharpEdgesInIt) {
  std::vector<double> rows;
  for (const double x : {-20.0, 0.0, 20.0})
    add_rows(optics_of(1), x, rows);
  const auto [least, most] = std::minmax_element(rows.begin(), rows.end());
  EXPECT_GT(*most / *least, 1.8);
  int between = 0;
  for (const double row : rows)
    between += row > *least * 1.3 && row < *most * 0.75;
  EXPECT_LT(between, static_cast<int>(rows.size()) / 10);
}

double spread_across(StripeShape shape) {
  const Optics optics = optics_of(1);
  const Solid solid = matt(wall({0, 0, 40}, -10, 80));
  Realism realism = ideal();
  realism.look.shape = shape;
  Renderer renderer(optics, &solid, realism);
  const Frame lit = renderer.take({at(0, true)}), dark = renderer.take({at(0, false)});
  const ImagePoint pixel = *project(optics.camera, {0, sheet_y(optics.laser, 40), 40});
  const int v = static_cast<int>(std::lround(pixel.v));
  const double middle = *centre(lit, dark, v, pixel.u);
  double sum = 0, third = 0;
  for (int u = static_cast<int>(middle) - 9; u < middle + 10; ++u) {
    const double light = lit.row(v)[u] - dark.row(v)[u];
    sum += light;
    third += light * std::pow(u - middle, 3);
  }
  return third / sum;
}

TEST(Stripe, OnlyTheSkewedProfileIsSkewed) {
  EXPECT_LT(std::abs(spread_across(StripeShape::kGaussian)), 0.15);
  EXPECT_LT(std::abs(spread_across(StripeShape::kTopHat)), 0.15);
  EXPECT_GT(std::abs(spread_across(StripeShape::kSkewed)), 0.25);
}

// The wall lies in the middle of the sheet, and its light is the same everywhere. Its pixels
// therefore differ only by speckle.
TEST(Stripe, SpeckleHasAtLeastItsContrastAndAGrainOfOneToTwoPixels) {
  class Bright final : public Subject {
   public:
    std::optional<RayHit> first_hit(const Vec3& from, const Vec3& direction) const override {
      const double t = -from.x / direction.x;
      return RayHit{from + direction * t, {1, 0, 0}, 0.8, 0};
    }
    bool shadowed(const RayHit&, const Vec3&) const override { return false; }
    void near_plane(const Vec3&, double, double,
                    const std::function<void(ConvexPolygon)>& visit) const override {
      const Vec3 corners[] = {{0, -20, 20}, {0, 20, 20}, {0, 20, 60}, {0, -20, 60}};
      visit(corners);
    }
    int ambient_step() const override { return 8; }
    double ambient_light() const override { return 0; }
  };
  Optics optics = optics_of(1);
  optics.laser.sigma = 1000;  // makes the sheet equally bright everywhere
  const LocalOptics view = optics_in({}, optics);
  const PixelRays rays(optics.camera);
  const auto light = stripe_light(view, rays, Bright(), {.speckle = 0.33}, 7);
  const ImagePoint pixel = *project(optics.camera, {0, 0, 40});
  const auto from = [&](int u, int v) {
    return light[static_cast<std::size_t>(static_cast<int>(pixel.v) + v) * kSensorWidth +
                 static_cast<std::size_t>(static_cast<int>(pixel.u) + u)];
  };
  double sum = 0, squares = 0, next = 0, third = 0;
  constexpr int kHalf = 80, kCount = 4 * kHalf * kHalf;
  for (int v = -kHalf; v < kHalf; ++v) {
    for (int u = -kHalf; u < kHalf; ++u) {
      const double value = from(u, v);
      sum += value;
      squares += value * value;
      next += value * from(u + 1, v);
      third += value * from(u + 3, v);
    }
  }
  const double mean = sum / kCount, variance = squares / kCount - mean * mean;
  EXPECT_GE(std::sqrt(variance) / mean, 0.3);
  EXPECT_LE(std::sqrt(variance) / mean, 0.36);
  EXPECT_GT((next / kCount - mean * mean) / variance, 0.3);
  EXPECT_LT(std::abs(third / kCount - mean * mean) / variance, 0.1);
}

}  // namespace
}  // namespace vitrine::acquisition::rig::test
