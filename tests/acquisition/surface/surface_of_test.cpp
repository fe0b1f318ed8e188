// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/surface_of.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "acquisition/surface/shapes.h"
#include "codec/repair/repair.h"

namespace vitrine::acquisition {
namespace {

using testing::HasSubstr;

struct Topology {
  std::size_t most = 0;      // largest number of faces at one edge
  std::size_t boundary = 0;  // number of edges with one face
  bool oriented = true;      // whether no edge is traversed twice in the same direction
};

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// Returns the number of faces that traverse each directed edge.
std::map<Edge, std::size_t> edges_of(const TriangleMesh& mesh) {
  std::map<Edge, std::size_t> ways;
  for (const Triangle& f : mesh.faces) {
    for (std::size_t k = 0; k < 3; ++k)
      ++ways[{f[k], f[(k + 1) % 3]}];
  }
  return ways;
}

std::vector<Edge> boundary_of(const TriangleMesh& mesh) {
  std::vector<Edge> boundary;
  const auto ways = edges_of(mesh);
  for (const auto& [edge, count] : ways) {
    if (!ways.contains({edge.second, edge.first})) boundary.push_back(edge);
  }
  return boundary;
}

Topology topology_of(const TriangleMesh& mesh) {
  const auto ways = edges_of(mesh);
  Topology topology;
  for (const auto& [edge, count] : ways) {
    const auto back = ways.find({edge.second, edge.first});
    const std::size_t other = back == ways.end() ? 0 : back->second;
    topology.most = std::max(topology.most, count + other);
    topology.boundary += count + other == 1;
    topology.oriented &= count == 1;
  }
  return topology;
}

TriangleMesh mesh_of(const std::vector<Profile>& profiles, const SurfaceOptions& options = {}) {
  const auto surface = surface_of(profiles, options);
  EXPECT_TRUE(surface.has_value()) << surface.error().message;
  return surface ? surface->mesh : TriangleMesh{};
}

double signed_volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& f : mesh.faces)
    sum += dot(mesh.positions[f[0]], cross(mesh.positions[f[1]], mesh.positions[f[2]]));
  return sum / 6;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& f : mesh.faces)
    sum += length(cross(mesh.positions[f[1]] - mesh.positions[f[0]],
                        mesh.positions[f[2]] - mesh.positions[f[0]]));
  return sum / 2;
}

TEST(Surface, OfACylinderClosesTheTurnAndNothingElse) {
  const auto surface = surface_of(scan_of(cylinder(20)), {});
  ASSERT_TRUE(surface.has_value());
  EXPECT_EQ(surface->mesh.positions.size(), 90 * 60);
  EXPECT_EQ(surface->mesh.faces.size(), 2 * 90 * 59);
  const Topology topology = topology_of(surface->mesh);
  EXPECT_EQ(topology.most, 2);
  EXPECT_EQ(topology.boundary, 2 * 90);  // top and bottom stay open
  EXPECT_TRUE(topology.oriented);
  EXPECT_NEAR(area(surface->mesh), 2 * std::numbers::pi * 20 * 30, 5);
  EXPECT_EQ(surface->report.points, 90 * 60);
  EXPECT_EQ(surface->report.outliers + surface->report.isolated + surface->report.filled, 0);
}

TEST(Surface, ItsFacesAreCounterClockwiseFromOutside) {
  EXPECT_GT(signed_volume(mesh_of(scan_of(ellipsoid(20, 18, 15)))), 0);
  EXPECT_GT(signed_volume(mesh_of(scan_of(box(12)))), 0);
}

TEST(Surface, DoesNotDependOnTheOrderOfProfiles) {
  auto profiles = scan_of(ellipsoid(20, 18, 15));
  const TriangleMesh in_order = mesh_of(profiles);
  std::shuffle(profiles.begin(), profiles.end(), std::mt19937(4));
  const TriangleMesh shuffled = mesh_of(profiles);
  EXPECT_EQ(shuffled.positions, in_order.positions);
  EXPECT_EQ(shuffled.faces, in_order.faces);
}

// The laser plane passes the axis at a distance of 3 mm, so every point is 3 mm beside the axis.
TEST(Surface, OfAPlaneBesideTheAxisIsTheSameCylinder) {
  auto profiles = scan_of(cylinder(std::sqrt(20. * 20 - 9)));
  for (Profile& profile : profiles) {
    for (ProfilePoint& point : profile.points)
      point.at.lateral = 3;
  }
  const TriangleMesh mesh = mesh_of(profiles);
  EXPECT_EQ(mesh.faces.size(), 2 * 90 * 59);
  for (const Vec3& p : mesh.positions)
    EXPECT_NEAR(std::hypot(p.x, p.y), 20, 1e-9);
}

// A cup: the camera sees its inner wall only on the other side of the axis, where rho is negative.
TEST(Surface, BeyondTheAxisFacesTheLaserToo) {
  auto profiles = scan_of(cylinder(20), {.rows = 40});
  for (Profile& profile : profiles) {
    for (ProfilePoint& point : profile.points)
      point.at.rho = -20;
  }
  const TriangleMesh mesh = mesh_of(profiles);
  EXPECT_EQ(mesh.faces.size(), 2 * 90 * 39);
  EXPECT_LT(signed_volume(mesh), 0);
}

TEST(Surface, WhatIsSeenASecondTimeBeyondTheAxisIsDropped) {
  auto profiles = scan_of(cylinder(20));
  for (Profile& profile : profiles) {
    for (int row = 60; row < 70; ++row)
      profile.points.push_back({{-20.1, 0, .5 * (row - 60)}, row});
  }
  const auto surface = surface_of(profiles, {});
  ASSERT_TRUE(surface.has_value());
  EXPECT_EQ(surface->report.seen_twice, 900);
  EXPECT_EQ(surface->mesh.faces.size(), 2 * 90 * 59);
}

// Each profile has points in other rows than its neighbours.
TEST(Surface, OfUnequalProfilesIsClosedWithoutOverlap) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    auto profiles = scan_of(cylinder(20), {.rows = 300});
    for (Profile& profile : profiles) {
      std::vector<ProfilePoint> kept;
      int chosen = 0;
      for (const ProfilePoint& point : profile.points) {
        if (point.row % 5 == 0) chosen = point.row + static_cast<int>(random() % 5);
        if (point.row == 0 || point.row == 299 || point.row == chosen) kept.push_back(point);
      }
      profile.points = kept;
    }
    const TriangleMesh mesh = mesh_of(profiles);
    EXPECT_NEAR(area(mesh), 2 * std::numbers::pi * 20 * 30, 40);
    const Topology topology = topology_of(mesh);
    EXPECT_EQ(topology.most, 2);
    EXPECT_TRUE(topology.oriented);
  }
}

TEST(Surface, OfAnySamplingHasNoHoles) {
  const auto profiles = scan_of(ellipsoid(20, 18, 15), {.rows = 400, .noise = .02});
  for (const auto method :
       {SamplingMethod::kEquidistant, SamplingMethod::kPaper, SamplingMethod::kAdaptive}) {
    for (const int length : {5, 10, 15, 20}) {
      SCOPED_TRACE(length);
      const TriangleMesh mesh =
          mesh_of(profiles, {.sampling = {.method = method, .window = length, .noise = .02}});
      const Topology topology = topology_of(mesh);
      EXPECT_EQ(topology.most, 2);
      // At most the two rims and the uneven ends of the profiles are open boundaries.
      EXPECT_LE(topology.boundary, 2 * 90 + 2 * 90 * 2);
      EXPECT_GT(signed_volume(mesh), 0);
    }
  }
}

// Two stacked cylinders: the depth changes by 8 mm from one row to the next.
TEST(Surface, AtADepthDiscontinuityAGapStays) {
  const auto step = [](double, double z) { return z > 15 ? 12. : 20.; };
  const TriangleMesh mesh = mesh_of(scan_of(step));
  EXPECT_EQ(topology_of(mesh).boundary, 4 * 90);
  for (const Triangle& f : mesh.faces) {
    const auto rho = [&](std::uint32_t v) {
      return std::hypot(mesh.positions[v].x, mesh.positions[v].y);
    };
    EXPECT_NEAR(rho(f[0]), rho(f[1]), 1e-9);
    EXPECT_NEAR(rho(f[0]), rho(f[2]), 1e-9);
  }
}

// The depth changes by 1.7 mm between two rows. By [WLL] eq. 5, the rows are not joined, because
// this exceeds 4 s_max = 1.68 mm. By eq. 6 they are joined: the angle between view and normal is 74
// degrees, below the default `largest_angle` of 75.
TEST(Surface, AGrazingStepIsNoDiscontinuity) {
  const auto step = [](double, double z) { return z > 4.75 ? 20 : 21.7; };
  const auto profiles = scan_of(step, {.profiles = 360, .rows = 20, .top = 9.5});
  const SurfaceOptions steep = {.largest_spacing = .42};
  const SurfaceOptions flat = {.largest_spacing = .42, .largest_angle = 60};
  EXPECT_EQ(mesh_of(profiles, steep).faces.size(), 2 * 360 * 19);
  EXPECT_EQ(mesh_of(profiles, flat).faces.size(), 2 * 360 * 18);
}

// Along the whole slope, the depth changes by 1.8 mm between adjacent rows, which are 0.25 mm
// apart. The slope is therefore 82 degrees.
TEST(Surface, ASlopeThatIsGrazedAllAlongIsWhole) {
  const auto cone = [](double, double z) { return 45 - 7.2 * z; };
  const auto profiles = scan_of(cone, {.profiles = 360, .rows = 20, .top = 4.75});
  EXPECT_EQ(mesh_of(profiles, {.largest_spacing = .42}).faces.size(), 2 * 360 * 19);
}

// A tilted slope: its height changes by up to .35 mm from one profile to the next. The depth
// therefore changes by up to 2.5 mm between profiles and by 1.8 mm between rows.
TEST(Surface, ASlopeThatRunsAcrossTheRowsIsWholeToo) {
  const auto cone = [](double angle, double z) -> std::optional<double> {
    const double rho = 45 - 7.2 * (z - 20 - 20 * std::sin(angle));
    return rho < 10 || rho > 45 ? std::nullopt : std::optional(rho);
  };
  const auto profiles = scan_of(cone, {.profiles = 360, .rows = 181, .top = 45});
  const TriangleMesh mesh = mesh_of(profiles, {.largest_spacing = .5, .largest_angle = 60});
  const double rim = 2 * 1.8;
  const auto is_inside = [&](std::uint32_t v) {
    const double rho = std::hypot(mesh.positions[v].x, mesh.positions[v].y);
    return rho > 10 + rim && rho < 45 - rim;
  };
  for (const auto& [from, to] : boundary_of(mesh))
    EXPECT_FALSE(is_inside(from) && is_inside(to)) << from << ' ' << to;
}

TEST(Surface, SpecksAndOutliersVanish) {
  auto profiles = scan_of(cylinder(20));
  for (std::size_t k = 10; k < 14; ++k) {  // a reflection of 4 x 4 points
    for (std::size_t i = 20; i < 24; ++i)
      profiles[k].points[i].at.rho = 45;
  }
  profiles[50].points[30].at.rho = 28;
  const auto surface = surface_of(profiles, {});
  ASSERT_TRUE(surface.has_value());
  EXPECT_EQ(surface->report.isolated, 16);
  EXPECT_EQ(surface->report.outliers, 1);
  for (const Vec3& p : surface->mesh.positions)
    EXPECT_LT(std::hypot(p.x, p.y), 21);
}

// A thin wall, like the brim of a hat, appears in two rows of all profiles.
TEST(Surface, AThinWallSeenOnFewRowsStays) {
  auto profiles = scan_of(cylinder(20));
  for (Profile& profile : profiles) {
    for (const std::size_t i : {30, 31})
      profile.points[i].at.rho = 32;
  }
  const auto surface = surface_of(profiles, {});
  ASSERT_TRUE(surface.has_value());
  EXPECT_EQ(surface->report.isolated + surface->report.outliers, 0);
  EXPECT_EQ(std::ranges::count_if(surface->mesh.positions,
                                  [](const Vec3& p) { return std::hypot(p.x, p.y) > 30; }),
            2 * 90);
}

TEST(Surface, ASmallGapIsFilledLinearlyALargeOneIsNot) {
  auto profiles = scan_of([](double, double z) { return 20 + .1 * z; });
  const auto erase = [](Profile& profile, int from, int to) {
    std::erase_if(profile.points,
                  [=](const ProfilePoint& p) { return p.row >= from && p.row < to; });
  };
  erase(profiles[3], 10, 12);
  for (std::size_t k = 20; k < 40; ++k)
    erase(profiles[k], 30, 40);
  const auto surface = surface_of(profiles, {.largest_hole = 2});
  ASSERT_TRUE(surface.has_value());
  EXPECT_EQ(surface->report.filled, 2);
  EXPECT_EQ(surface->mesh.positions.size(), 90 * 60 - 200);
  for (const Vec3& p : surface->mesh.positions)
    EXPECT_NEAR(std::hypot(p.x, p.y), 20 + .1 * p.z, 1e-9);
  const auto unfilled = surface_of(profiles, {.largest_hole = 0});
  ASSERT_TRUE(unfilled.has_value());
  EXPECT_EQ(unfilled->report.filled, 0);
}

// The laser misses the top of the object, which leaves a hole with a diameter between 1 and 2 mm.
TEST(Surface, ASmallHoleInTheMeshIsClosed) {
  const auto dome = [](double, double z) { return std::sqrt(20 * 20 - z * z); };
  const Scanned how = {.profiles = 180, .rows = 400, .top = 19.99, .bottom = 0};
  EXPECT_EQ(topology_of(mesh_of(scan_of(dome, how), {.largest_hole = 2})).boundary, 180);
  EXPECT_EQ(topology_of(mesh_of(scan_of(dome, how), {.largest_hole = 1})).boundary, 360);
}

// Merges two scans. Each row then has the points of both surfaces, in random order.
std::vector<Profile> both(std::vector<Profile> profiles, const std::vector<Profile>& others) {
  std::mt19937 random(1);
  for (std::size_t k = 0; k < profiles.size(); ++k) {
    auto& points = profiles[k].points;
    points.insert(points.end(), others[k].points.begin(), others[k].points.end());
    std::ranges::shuffle(points, random);
    std::ranges::stable_sort(points, {}, &ProfilePoint::row);
  }
  return profiles;
}

TEST(Surface, OfTwoInEachRowIsBoth) {
  const TriangleMesh mesh = mesh_of(both(scan_of(cylinder(20)), scan_of(cylinder(12))));
  EXPECT_EQ(mesh.faces.size(), 2 * (2 * 90 * 59));
  const Topology topology = topology_of(mesh);
  EXPECT_EQ(topology.most, 2);
  EXPECT_EQ(topology.boundary, 4 * 90);
  EXPECT_TRUE(topology.oriented);
}

// A pocket lies in front of a wall, so some rows of some profiles show two surfaces.
TEST(Surface, OfTwoInSomeRowsIsBothThere) {
  auto pocket = scan_of(cylinder(24));
  for (std::size_t k = 0; k < pocket.size(); ++k) {
    std::erase_if(pocket[k].points, [&](const ProfilePoint& p) {
      return k < 20 || k >= 40 || p.row < 10 || p.row >= 30;
    });
  }
  const TriangleMesh mesh = mesh_of(both(scan_of(cylinder(20)), pocket));
  EXPECT_EQ(mesh.faces.size(), 2 * 90 * 59 + 2 * 19 * 19);
  EXPECT_EQ(topology_of(mesh).boundary, 2 * 90 + 4 * 19);
}

// The two surfaces are closer than the limit for joining points, but must stay separate.
TEST(Surface, OfTwoThatAreCloseJoinsNoneToTheOther) {
  const TriangleMesh mesh = mesh_of(both(scan_of(cylinder(20)), scan_of(cylinder(18))));
  EXPECT_EQ(mesh.faces.size(), 2 * (2 * 90 * 59));
  for (const Triangle& f : mesh.faces) {
    const auto rho = [&](std::uint32_t v) {
      return std::hypot(mesh.positions[v].x, mesh.positions[v].y);
    };
    EXPECT_NEAR(rho(f[0]), rho(f[1]), 1e-9);
    EXPECT_NEAR(rho(f[0]), rho(f[2]), 1e-9);
  }
}

TEST(Surface, ASecondSurfaceOfFewPointsVanishes) {
  auto speck = scan_of(cylinder(30));
  for (std::size_t k = 0; k < speck.size(); ++k) {
    std::erase_if(speck[k].points, [&](const ProfilePoint& p) {
      return k < 20 || k >= 24 || p.row < 10 || p.row >= 15;
    });
  }
  const auto surface = surface_of(both(scan_of(cylinder(20)), speck), {});
  ASSERT_TRUE(surface.has_value());
  EXPECT_EQ(surface->report.isolated, 20);
  EXPECT_EQ(surface->mesh.faces.size(), 2 * 90 * 59);
}

double rms_rho(const TriangleMesh& mesh, const std::function<double(const Vec3&)>& error) {
  double sum = 0;
  for (const Vec3& p : mesh.positions)
    sum += error(p) * error(p);
  return std::sqrt(sum / static_cast<double>(mesh.positions.size()));
}

TEST(Surface, NoiseIsSmoothedWithinWhatTheSensorHas) {
  const auto error = [](const Vec3& p) { return std::hypot(p.x, p.y) - 20; };
  const auto profiles = scan_of(cylinder(20), {.noise = .03});
  const double raw = rms_rho(mesh_of(profiles), error);
  EXPECT_NEAR(raw, .03, .002);
  EXPECT_LT(rms_rho(mesh_of(profiles, {.noise = .03}), error), .5 * raw);
}

// A profile has two strands (lines of points along a surface, steps.h). The points of each row
// are in random order, so the order of the strands differs from profile to profile.
TEST(Surface, TwoInEachRowAreSmoothedAsOne) {
  const auto error = [](const Vec3& p) {
    const double rho = std::hypot(p.x, p.y);
    return std::min(std::abs(rho - 20), std::abs(rho - 12));
  };
  const auto profiles = both(scan_of(cylinder(20), {.noise = .03, .seed = 1}),
                             scan_of(cylinder(12), {.noise = .03, .seed = 2}));
  EXPECT_LT(rms_rho(mesh_of(profiles, {.noise = .03}), error),
            .5 * rms_rho(mesh_of(profiles), error));
}

TEST(Surface, AnEdgeIsNotSmoothedAway) {
  const auto error = [](const Vec3& p) { return std::max(std::abs(p.x), std::abs(p.y)) - 12; };
  const auto profiles = scan_of(box(12), {.profiles = 360, .noise = .03});
  const double raw = rms_rho(mesh_of(profiles), error);
  EXPECT_LT(rms_rho(mesh_of(profiles, {.noise = .03}), error), .7 * raw);
  double corner = 0;
  for (const Vec3& p : mesh_of(profiles, {.noise = .03}).positions)
    corner = std::max(corner, std::hypot(p.x, p.y));
  EXPECT_GT(corner, 12 * std::sqrt(2) - .05);
}

TEST(Surface, WithoutNoiseNothingIsMoved) {
  const auto profiles = scan_of(ellipsoid(20, 18, 15));
  const auto surface = surface_of(profiles, {});
  ASSERT_TRUE(surface.has_value());
  EXPECT_EQ(surface->report.smoothed, 0);
  std::size_t k = 0;
  for (const Profile& profile : profiles) {
    for (const ProfilePoint& point : profile.points) {
      if (k < surface->mesh.positions.size() &&
          surface->mesh.positions[k] == position(profile, point))
        ++k;
    }
  }
  EXPECT_EQ(k, surface->mesh.positions.size());
}

TEST(Surface, TooLittleIsRefusedWithAReason) {
  const auto empty = surface_of({}, {});
  ASSERT_FALSE(empty.has_value());
  EXPECT_THAT(empty.error().message, HasSubstr("0 profiles do not make a surface"));
  const auto none = surface_of(std::vector<Profile>(4), {});
  ASSERT_FALSE(none.has_value());
  EXPECT_THAT(none.error().message, HasSubstr("1 profiles do not make a surface"));
  std::vector<Profile> empty_turn(4);
  for (std::size_t k = 0; k < empty_turn.size(); ++k)
    empty_turn[k].theta = 90. * static_cast<double>(k);
  const auto nothing = surface_of(empty_turn, {});
  ASSERT_FALSE(nothing.has_value());
  EXPECT_THAT(nothing.error().message, HasSubstr("of 0 points"));
}

// Random profiles must give a mesh with a consistent orientation and at most two faces per edge.
// The import must accept it.
TEST(Surface, OfRandomProfilesIsEdgeManifold) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    const auto real = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    std::vector<Profile> profiles(3 + random() % 12);
    const double rough = real(0, 8);
    for (std::size_t k = 0; k < profiles.size(); ++k) {
      profiles[k].theta = 360. * static_cast<double>(k) / static_cast<double>(profiles.size());
      int row = 0;
      for (std::size_t i = 0, n = random() % 40; i < n; ++i) {
        row += 1 + static_cast<int>(random() % 4 == 0 ? random() % 9 : 0);
        for (std::size_t surfaces = 1 + random() % 2; surfaces > 0; --surfaces)
          profiles[k].points.push_back({{real(-2, 6) * rough / 4, real(-1, 1), -.3 * row}, row});
      }
    }
    for (const int window : {1, 5}) {
      const auto surface = surface_of(profiles, {.largest_hole = real(0, 6),
                                                 .smallest_piece = 3,
                                                 .noise = real(0, .2),
                                                 .sampling = {.window = window}});
      if (!surface) continue;
      const Topology topology = topology_of(surface->mesh);
      EXPECT_LE(topology.most, 2);
      EXPECT_TRUE(topology.oriented);
      EXPECT_TRUE(repair({.mesh = surface->mesh}).has_value());
    }
  }
}

// Two wavy sheets intersect. Each sheet lacks some rows, which are chosen at random for each
// profile. The strands of a profile (lines of points along a surface) therefore have gaps and
// change from one sheet to the other.
TEST(Surface, OfTwoRaggedSheetsIsEdgeManifold) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    const auto sheet = [&](double phase) {
      auto scan = scan_of([=](double angle, double z) {
        return 20 + 2 * std::sin(3 * angle + .3 * z + phase) * std::sin(.4 * z);
      });
      for (Profile& profile : scan) {
        const int from = static_cast<int>(random() % 60), to = static_cast<int>(random() % 60);
        std::erase_if(profile.points, [=](const ProfilePoint& p) {
          return p.row > std::min(from, to) && p.row < std::max(from, to);
        });
      }
      return scan;
    };
    const auto profiles = both(sheet(0), sheet(2));
    for (const int window : {1, 5}) {
      const TriangleMesh mesh = mesh_of(profiles, {.noise = .02, .sampling = {.window = window}});
      const Topology topology = topology_of(mesh);
      EXPECT_EQ(topology.most, 2);
      EXPECT_TRUE(topology.oriented);
      EXPECT_TRUE(repair({.mesh = mesh}).has_value());
    }
  }
}

}  // namespace
}  // namespace vitrine::acquisition
