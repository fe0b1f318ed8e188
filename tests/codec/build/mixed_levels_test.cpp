// SPDX-License-Identifier: Apache-2.0
// Checks the geometric errors that a file states: for whole levels, between regions of different
// levels, and for a camera's view. Compares many points of the displayed surface with the original,
// and many points of the original with the displayed surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <tuple>

#include "codec/build/build_model.h"
#include "codec/build/open_model.h"
#include "codec/export/write_mesh.h"
#include "codec/mesh/triangle_bvh.h"
#include "support/meshes.h"

namespace vitrine::test {
namespace {

constexpr double kRounding = 1 + 1e-6;

struct How {
  int bits;
  Placement placement;
};

// Returns a mesh file of the bust with small separate components around it. A level of the model
// inserts such a component as a whole.
std::vector<std::uint8_t> bust_with_specks() {
  TriangleMesh mesh = shipped_model("demosthenes.obj");
  const std::size_t vertices = mesh.positions.size();
  std::mt19937 random(1);
  for (int speck = 0; speck < 40; ++speck) {
    const auto first = static_cast<VertexId>(mesh.positions.size());
    const Vec3 middle = mesh.positions[random() % vertices] * 1.01;
    for (const Vec3& corner : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{-1, -1, -1}})
      mesh.positions.push_back(middle + corner * (0.002 * (1 + speck % 10)));
    for (const Triangle& f : {Triangle{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}})
      mesh.faces.push_back({first + f[0], first + f[1], first + f[2]});
  }
  return *write_mesh(mesh, MeshFormat::kPly);
}

TriangleMesh read_and_repair(const std::vector<std::uint8_t>& file) {
  return repair(std::move(*read_mesh(file)))->mesh;
}

BuildResult build(const std::vector<std::uint8_t>& file, const How& how) {
  BuildOptions options;
  options.bits = how.bits;
  options.placement = how.placement;
  options.region_vertices = 500;
  return std::move(*build_model(file, options, {}));
}

class Bust {
 public:
  explicit Bust(const How& how) : Bust(bust_with_specks(), how) {}

  const Manifest& manifest() const { return built_.report.manifest; }
  const TriangleMesh& original() const { return original_; }
  const TriangleBvh& bvh() const { return bvh_; }  // search tree of the original's triangles
  std::uint32_t leaf(VertexId original) const { return leaf_[original]; }

  Refiner start() const { return std::move(*open_model(built_.file)); }
  void apply(Refiner& refiner, std::size_t chunk) const {
    ASSERT_TRUE(refiner.apply(chunk, *chunks_of(manifest(), built_.file)(chunk)));
  }
  void refine_to(Refiner& refiner, const Want& want) const {
    ASSERT_TRUE(refine(refiner, want, chunks_of(manifest(), built_.file)));
  }

 private:
  Bust(const std::vector<std::uint8_t>& file, const How& how)
      : original_(read_and_repair(file)), bvh_(original_), built_(build(file, how)) {
    find_leaves();
  }

  // Finds the leaf region of each original vertex. At full resolution, the model's vertices are the
  // original vertices, rounded to the lattice.
  void find_leaves() {
    Refiner whole = start();
    refine_to(whole, WantLevel{static_cast<std::uint32_t>(manifest().levels.size() - 1)});
    const auto before = [](const Vec3i& a, const Vec3i& b) {
      return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    };
    std::map<Vec3i, std::uint32_t, decltype(before)> at(before);
    for (VertexId v = 0; v < whole.vertex_count(); ++v)
      at[whole.positions()[v]] = whole.region_of(v);
    for (const Vec3& p : original_.positions)
      leaf_.push_back(at.at(manifest().lattice.to_lattice(p)));
  }

  TriangleMesh original_;
  TriangleBvh bvh_;
  BuildResult built_;
  std::vector<std::uint32_t> leaf_;
};

// The level of the region at one corner of a face, and the error that this region states.
struct CornerRegion {
  std::uint32_t level;
  double stated;
};
using Places = std::array<CornerRegion, 3>;

// Finds the coarsest level of the three regions. Returns the smallest error that a region of this
// level states.
double least_stated(const Places& places) {
  const std::uint32_t coarsest = std::min({places[0].level, places[1].level, places[2].level});
  double least = std::numeric_limits<double>::infinity();
  for (const CornerRegion& p : places) {
    if (p.level == coarsest) least = std::min(least, p.stated);
  }
  return least;
}

bool is_mixed(const Places& places) {
  return places[0].level != places[1].level || places[0].level != places[2].level;
}

TrianglePoints corners_of(const TriangleMesh& mesh, const Triangle& f) {
  return {mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]]};
}

// Calls f for a grid of points on a triangle. The grid includes the corners and edges.
template <typename F>
void for_points(const TrianglePoints& t, double spacing, const F& f) {
  const double longest = std::max({length(t.b - t.a), length(t.c - t.b), length(t.a - t.c)});
  const int n = std::clamp(static_cast<int>(longest / spacing), 2, 30);
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; i + j <= n; ++j)
      f(t.a + (t.b - t.a) * (1.0 * i / n) + (t.c - t.a) * (1.0 * j / n));
  }
}

// The displayed surface of a refiner.
class DisplayedSurface {
 public:
  DisplayedSurface(const Bust& bust, const Refiner& refiner)
      : bust_(bust),
        refiner_(refiner),
        mesh_(refiner.display_mesh()),
        bvh_(mesh_),
        level_(bust.manifest().tree.leaves(), 0),
        spacing_(bust.manifest().lattice.step * (1 << bust.manifest().lattice.bits) / 100) {
    const Manifest& m = bust.manifest();
    for (std::size_t i = 0; i < m.chunks.size(); ++i) {
      const RegionNode& region = m.region(m.chunks[i]);
      if (refiner.is_applied(i))
        std::fill_n(level_.begin() + region.first, region.leaves, m.chunks[i].level);
    }
    const auto last = static_cast<std::uint32_t>(m.levels.size() - 1);
    for (std::uint32_t leaf = 0; leaf < level_.size(); ++leaf) {
      const std::size_t next = m.find_chunk(std::min(level_[leaf] + 1, last), leaf);
      const LatticeBox& box = m.region(m.chunks[next]).box;
      regions_.push_back(
          {m.lattice.to_model(box.low), m.lattice.to_model(box.high), place_of_leaf(leaf).stated});
    }
  }

  // Calls f(p, places) for a grid of points p on the displayed surface. `places` holds the regions
  // of the three corners of p's face.
  template <typename F>
  void for_displayed(const F& f) const {
    for (const Triangle& face : mesh_.faces) {
      const Places places{place(face[0]), place(face[1]), place(face[2])};
      for_points(corners_of(mesh_, face), spacing_, [&](const Vec3& p) { f(p, places); });
    }
  }
  // Like for_displayed(), but for a grid of points on the original surface.
  template <typename F>
  void for_original(const F& f) const {
    for (const Triangle& face : bust_.original().faces) {
      const Places places{place_of_leaf(bust_.leaf(face[0])), place_of_leaf(bust_.leaf(face[1])),
                          place_of_leaf(bust_.leaf(face[2]))};
      for_points(corners_of(bust_.original(), face), spacing_,
                 [&](const Vec3& p) { f(p, places); });
    }
  }

  double to_original(const Vec3& p) const { return std::sqrt(bust_.bvh().closest(p).squared); }
  ClosestTriangle closest(const Vec3& p) const { return bvh_.closest(p); }
  // Enlarges the box of each region by the error that the region states. Returns the largest stated
  // error among the boxes that contain p. A camera that sees p also sees these boxes, so it
  // requests their regions if the error is too large.
  double most_around(const Vec3& p) const {
    double most = 0;
    for (const RegionErrorBox& region : regions_) {
      const Vec3 low = region.low - p, high = p - region.high;
      if (std::max({low.x, low.y, low.z, high.x, high.y, high.z}) <= region.stated)
        most = std::max(most, region.stated);
    }
    return most;
  }

 private:
  CornerRegion place(VertexId displayed) const {
    return place_at(refiner_.level_of(displayed), refiner_.region_of(displayed));
  }
  CornerRegion place_of_leaf(std::uint32_t leaf) const { return place_at(level_[leaf], leaf); }
  CornerRegion place_at(std::uint32_t level, std::uint32_t leaf) const {
    const Manifest& m = bust_.manifest();
    const std::size_t chunk = m.find_chunk(level, leaf);
    return {level, chunk < m.chunks.size() ? m.chunks[chunk].max_error : m.levels[0].max_error};
  }

  struct RegionErrorBox {
    Vec3 low, high;
    double stated;
  };

  const Bust& bust_;
  const Refiner& refiner_;
  TriangleMesh mesh_;
  TriangleBvh bvh_;
  std::vector<std::uint32_t> level_;     // per leaf: the level of its region
  std::vector<RegionErrorBox> regions_;  // per leaf: its region
  double spacing_;
};

// Keeps the largest ratio of a distance to its allowed maximum.
struct Largest {
  double share = 0;
  std::size_t mixed = 0;

  void add(double value, double allowed, bool is_mixed) {
    share = std::max(share, value / allowed);
    mixed += is_mixed ? 1 : 0;
  }
};

class MixedLevels : public testing::TestWithParam<How> {
 protected:
  const Bust bust{GetParam()};
  const Manifest& m = bust.manifest();
};

TEST_P(MixedLevels, AreMadeOfManyRegionsAndInsertions) {
  EXPECT_GT(m.tree.leaves(), 8u);
  const auto inserted = [](std::uint32_t sum, const ChunkInfo& c) { return sum + c.inserted; };
  EXPECT_GT(std::accumulate(m.chunks.begin(), m.chunks.end(), 0u, inserted), 100u);
}

TEST_P(MixedLevels, AtWholeLevelsEachRegionIsWithinWhatItStates) {
  Refiner refiner = bust.start();
  for (std::uint32_t level = 0; level < m.levels.size(); level += 3) {
    SCOPED_TRACE(level);
    bust.refine_to(refiner, WantLevel{level});
    const DisplayedSurface shown(bust, refiner);
    Largest there, back;
    shown.for_displayed([&](const Vec3& p, const Places& places) {
      there.add(shown.to_original(p), least_stated(places), is_mixed(places));
    });
    shown.for_original([&](const Vec3& p, const Places& places) {
      back.add(std::sqrt(shown.closest(p).squared), least_stated(places), is_mixed(places));
    });
    EXPECT_LE(there.share, kRounding);
    EXPECT_LE(back.share, kRounding);
  }
}

TEST_P(MixedLevels, ShowNothingFartherOffThanTheRegionsAtHandState) {
  Refiner refiner = bust.start();
  std::mt19937 random(1);
  Largest there, back, box;
  for (int step = 1;; ++step) {
    std::vector<std::size_t> ready;
    for (std::size_t i = 0; i < m.chunks.size(); ++i) {
      if (refiner.is_ready(i)) ready.push_back(i);
    }
    if (ready.empty()) break;
    bust.apply(refiner, ready[random() % ready.size()]);
    if (step % 20 != 0) continue;
    const DisplayedSurface shown(bust, refiner);
    shown.for_displayed([&](const Vec3& p, const Places& places) {
      const double d = shown.to_original(p);
      there.add(d, least_stated(places), is_mixed(places));
      box.add(d, shown.most_around(p), is_mixed(places));
    });
    shown.for_original([&](const Vec3& p, const Places& places) {
      back.add(std::sqrt(shown.closest(p).squared), shown.most_around(p), is_mixed(places));
    });
  }
  EXPECT_LE(there.share, kRounding);
  EXPECT_LE(box.share, kRounding);
  EXPECT_LE(back.share, kRounding);
  EXPECT_GT(there.mixed, 1'000u);
  EXPECT_GT(back.mixed, 1'000u);
}

// A camera, given by its position and its axes.
struct PinholeCamera {
  Vec3 eye, right, up, back;
  View view;

  // Returns the largest number of pixels that an offset of length `offset` can cover at point p.
  // Returns 0 if the camera does not see p.
  double pixels(const Vec3& p, double offset) const {
    const Vec3 d = p - eye;
    const double depth = -dot(d, back);
    const double half = std::tan(view.field_of_view / 2 * std::numbers::pi / 180) * depth;
    const bool seen = depth > 0 && std::abs(dot(d, up)) <= half &&
                      std::abs(dot(d, right)) <= half * view.width / view.height;
    return seen ? offset * view.height / (2 * half) : 0;
  }
};

Vec3 unit(const Vec3& v) {
  return v * (1 / length(v));
}

PinholeCamera look_at(const Vec3& target, const Vec3& eye, double degrees, double height) {
  PinholeCamera c;
  c.eye = eye;
  c.back = unit(eye - target);
  c.right = unit(cross(Vec3{0.1, 1, 0.2}, c.back));
  c.up = cross(c.back, c.right);
  c.view = {.camera = {c.right.x, c.right.y, c.right.z, 0, c.up.x, c.up.y, c.up.z, 0, c.back.x,
                       c.back.y, c.back.z, 0, eye.x, eye.y, eye.z, 1},
            .field_of_view = degrees,
            .width = 1.5 * height,
            .height = height};
  return c;
}

TEST_P(MixedLevels, ShowACameraNoErrorAboveWhatItAllows) {
  constexpr double kAway = 0.4, kHeight = 100;
  std::mt19937 random(7);
  const auto anywhere = [&] {
    return bust.original().positions[random() % bust.original().positions.size()];
  };
  std::size_t mixed = 0;
  for (int i = 0; i < 6; ++i) {
    const double degrees = i == 0 ? 20 : 130;
    // The largest allowed error, in model units, at the distance kAway from the eye.
    const double allowed = i % 2 == 0 ? 0.012 : 0.0035;
    // The camera does not look straight at the target. In a wide view, the target is near the side.
    const Vec3 target = anywhere(), from = anywhere(), to = anywhere(), aside = anywhere();
    const Vec3 eye = target + unit(to - from) * kAway;
    PinholeCamera camera = look_at(target + (aside - target) * 0.8, eye, degrees, kHeight);
    camera.view.pixel_error =
        allowed / kAway * kHeight / (2 * std::tan(degrees / 2 * std::numbers::pi / 180));
    Refiner refiner = bust.start();
    bust.refine_to(refiner, camera.view);
    const DisplayedSurface shown(bust, refiner);
    Largest there, back;
    const auto look = [&](const Vec3& p, double distance, const Places& places, Largest& largest) {
      // Near the eye, even the error of full resolution may cover more than the allowed number of
      // pixels.
      const double least = camera.pixels(p, m.levels.back().max_error);
      largest.add(camera.pixels(p, distance), std::max(camera.view.pixel_error, least),
                  is_mixed(places));
    };
    shown.for_displayed([&](const Vec3& p, const Places& places) {
      if (camera.pixels(p, 1) > 0) look(p, shown.to_original(p), places, there);
    });
    shown.for_original([&](const Vec3& p, const Places& places) {
      if (camera.pixels(p, 1) > 0) look(p, std::sqrt(shown.closest(p).squared), places, back);
    });
    EXPECT_LE(there.share, kRounding) << degrees;
    EXPECT_LE(back.share, kRounding) << degrees;
    mixed += there.mixed;
  }
  EXPECT_GT(mixed, 100u);
}

INSTANTIATE_TEST_SUITE_P(
    Builds, MixedLevels,
    testing::Values(How{12, Placement::kMidpoint}, How{16, Placement::kMidpoint},
                    How{12, Placement::kPyramid}, How{16, Placement::kPyramid}),
    [](const auto& how) {
      return (how.param.placement == Placement::kMidpoint ? "Midpoint" : "Pyramid") +
             std::to_string(how.param.bits);
    });

}  // namespace
}  // namespace vitrine::test
