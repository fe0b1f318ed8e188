// SPDX-License-Identifier: Apache-2.0
// Tests surfaces that lie one behind the other and are both lit and visible in the same rows of a
// picture. The tests cover all steps from the pictures to the mesh.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>

#include "acquisition/profile/profile_of.h"
#include "acquisition/surface/surface_of.h"
#include "support/rig_calibration.h"
#include "support/rig_scenes.h"

namespace vitrine::acquisition::rig::test {
namespace {

// Distances of the two sheets from the axis, in mm. At these distances, the first and the last
// profile are too far apart to be joined.
constexpr double kFront = 38, kBehind = 16;
constexpr double kHeight = 40;  // in mm: height of the rear sheet; the front sheet is half as high
constexpr double kStep = .5;    // angle between profiles, in degrees
constexpr int kSteps = 17;

TriangleMesh two_sheets() {
  TriangleMesh mesh;
  add_quad(mesh, {kFront, -8, 0}, {0, 16, 0}, {0, 0, kHeight / 2});
  add_quad(mesh, {kBehind, -8, 0}, {0, 16, 0}, {0, 0, kHeight});
  return mesh;
}

// Returns profiles at angles at which both sheets face the laser.
std::vector<Profile> profiles() {
  const Optics optics = optics_of(1);
  const Calibration calibration = perfect_calibration(1);
  const Solid solid = matt(two_sheets());
  Renderer renderer(optics, &solid, ideal());
  std::vector<Profile> profiles;
  for (int step = 0; step < kSteps; ++step) {
    const double angle = kStep * (step - kSteps / 2);
    const Frame lit = renderer.take({at(angle, true)}), dark = renderer.take({at(angle, false)});
    profiles.push_back(profile_of(*find_stripe(lit, dark), calibration, angle));
  }
  return profiles;
}

double across(const Vec3& p, double sheet) {
  return std::abs(p.x - sheet);
}

double area_on(const TriangleMesh& mesh, double sheet) {
  double sum = 0;
  for (const Triangle& face : mesh.faces) {
    const Vec3 &a = mesh.positions[face[0]], &b = mesh.positions[face[1]],
               &c = mesh.positions[face[2]];
    if (std::max({across(a, sheet), across(b, sheet), across(c, sheet)}) < .2)
      sum += length(cross(b - a, c - a)) / 2;
  }
  return sum;
}

// Returns the height, in mm, above which the front sheet casts no shadow on the rear sheet.
double shade() {
  const Vec3 source = optics_of(1).laser.source;
  const double slope = (source.z - kHeight / 2) / (source.x - kFront);
  return kHeight / 2 - slope * (kFront - kBehind);
}

double width_of(double sheet) {
  return 2 * sheet * std::tan(kStep * (kSteps / 2) * std::numbers::pi / 180);
}

TEST(TwoSheets, AreBothInTheRowsThatShowBoth) {
  for (const Profile& profile : profiles()) {
    std::map<int, int> in_row;
    for (const ProfilePoint& point : profile.points) {
      const Vec3 p = position(profile, point);
      EXPECT_LT(std::min(across(p, kFront), across(p, kBehind)), .3) << "row " << point.row;
      ++in_row[point.row];
    }
    EXPECT_GT(std::ranges::count_if(in_row, [](const auto& row) { return row.second == 2; }), 10);
  }
}

TEST(TwoSheets, AreBothWholeInTheMesh) {
  const auto surface = surface_of(profiles(), {});
  ASSERT_TRUE(surface.has_value()) << surface.error().message;
  const double front = width_of(kFront) * kHeight / 2,
               behind = width_of(kBehind) * (kHeight - shade());
  EXPECT_NEAR(area_on(surface->mesh, kFront), front, .02 * front);
  EXPECT_NEAR(area_on(surface->mesh, kBehind), behind, .02 * behind);
}

}  // namespace
}  // namespace vitrine::acquisition::rig::test
