// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/simplify.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "codec/format/cell.h"
#include "codec/format/lattice_attributes.h"
#include "codec/format/placement.h"
#include "codec/simplify/collapse_rules.h"
#include "codec/simplify/surface.h"
#include "support/hierarchies.h"
#include "support/meshes.h"
#include "support/random_mesh.h"
#include "support/validate.h"

namespace vitrine::test {
namespace {

// Performs the recorded collapses on plain lists of faces, independently of the code under test.
class Replay {
 public:
  Replay(const LatticeMesh& fine, const Hierarchy& hierarchy)
      : hierarchy_(hierarchy),
        faces_(fine.faces),
        positions_(fine.positions),
        loops_(hierarchy.loops) {
    link();
  }

  // Performs the collapses of a level. As in Hierarchy, level 1 is the coarsest level with
  // collapses.
  void collapse_level(std::uint32_t level) {
    std::set<VertexId> ends;
    const Vec3i* last = nullptr;
    for (const Component& c : hierarchy_.insertions[level - 1])
      ASSERT_NO_FATAL_FAILURE(take_out(c, level));
    for (const Collapse& c : hierarchy_.levels[level - 1]) {
      ASSERT_TRUE(ends.insert(c.v1).second && ends.insert(c.v2).second) << "a shared end point";
    }
    ASSERT_NO_FATAL_FAILURE(check_independence(level, ends));
    for (const Collapse& c : hierarchy_.levels[level - 1]) {
      ASSERT_NO_FATAL_FAILURE(collapse(c, level));
      ASSERT_TRUE(last == nullptr || *last < positions_[c.v1]) << "v~ does not ascend";
      last = &positions_[c.v1];
    }
    ASSERT_NO_FATAL_FAILURE(coarsen_lattice(level));
  }

  // Expects that the level's closed mesh is a manifold and has the expected number of boundary
  // loops.
  void check_manifold() const {
    std::map<VertexId, std::uint32_t> index;
    std::vector<Triangle> faces;
    for (const Triangle& f : faces_) {
      Triangle g;
      for (std::size_t k = 0; k < 3; ++k) {
        g[k] = index.emplace(f[k], static_cast<std::uint32_t>(index.size())).first->second;
      }
      faces.push_back(g);
    }
    const auto mesh = Connectivity::close(static_cast<std::uint32_t>(index.size()), faces);
    ASSERT_TRUE(mesh.has_value()) << mesh.error().message;
    ASSERT_EQ(mesh->loop_count(), loops_);
    ASSERT_NO_FATAL_FAILURE(expect_valid(*mesh));
  }

  const std::vector<Triangle>& faces() const { return faces_; }
  const std::vector<Vec3i>& positions() const { return positions_; }

 private:
  void link() {
    neighbours_.assign(positions_.size(), {});
    faces_at_.assign(positions_.size(), {});
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        faces_at_[faces_[f][k]].push_back(f);
        neighbours_[faces_[f][k]].insert({faces_[f][(k + 1) % 3], faces_[f][(k + 2) % 3]});
      }
    }
  }

  // Removes a component that the level inserts. `component` must contain all its faces, with their
  // current positions.
  void take_out(const Component& component, std::uint32_t level) {
    const std::set<VertexId> ids(component.ids.begin(), component.ids.end());
    std::vector<Triangle> recorded, found;
    for (const Triangle& f : component.mesh.faces)
      recorded.push_back({component.ids[f[0]], component.ids[f[1]], component.ids[f[2]]});
    std::erase_if(faces_, [&](const Triangle& f) {
      const auto inside = std::ranges::count_if(f, [&](VertexId v) { return ids.contains(v); });
      if (inside == 3) found.push_back(f);
      EXPECT_TRUE(inside == 0 || inside == 3) << "a part of a component";
      return inside > 0;
    });
    ASSERT_EQ(canonical(recorded), canonical(found));
    const std::vector<std::uint32_t> region = regions_at(level);
    for (std::size_t i = 0; i < component.ids.size(); ++i) {
      ASSERT_EQ(component.mesh.positions[i], positions_[component.ids[i]]);
      ASSERT_EQ(region[component.ids[i]], region[component.ids[0]]);
    }
    const auto mesh =
        Connectivity::close(static_cast<std::uint32_t>(ids.size()), component.mesh.faces);
    ASSERT_TRUE(mesh.has_value()) << mesh.error().message;
    loops_ -= mesh->loop_count();
    link();
  }

  // Rounds the vertices to a coarser lattice. Expects that the hierarchy holds the lost bits of
  // every remaining vertex.
  void coarsen_lattice(std::uint32_t level) {
    const std::uint32_t bits = hierarchy_.shift[level - 1] - hierarchy_.shift[level];
    const auto& refined = hierarchy_.refined[level - 1];
    std::set<VertexId> left;
    for (const Triangle& f : faces_)
      left.insert(f.begin(), f.end());
    ASSERT_EQ(refined.size(), bits > 0 ? left.size() : 0);
    for (const Refined& r : refined) {
      ASSERT_EQ(positions_[r.vertex], r.cell);
      ASSERT_TRUE(left.erase(r.vertex));
      positions_[r.vertex] = cell_of(r.cell, bits);
    }
  }

  // Returns the region of each vertex at `level`.
  std::vector<std::uint32_t> regions_at(std::uint32_t level) const {
    std::vector<std::uint32_t> of_leaf(hierarchy_.tree.leaves());
    for (const std::uint32_t node : hierarchy_.tree.regions_at(level)) {
      const RegionNode& region = hierarchy_.tree.nodes[node];
      std::fill_n(of_leaf.begin() + region.first, region.leaves, node);
    }
    std::vector<std::uint32_t> regions;
    for (const std::uint16_t leaf : hierarchy_.leaf)
      regions.push_back(of_leaf[leaf]);
    return regions;
  }

  void check_independence(std::uint32_t level, const std::set<VertexId>& ends) const {
    const std::vector<std::uint32_t> region = regions_at(level);
    for (const Collapse& c : hierarchy_.levels[level - 1]) {
      ASSERT_EQ(region[c.v1], region[c.v2]) << "across regions";
      for (VertexId end : {c.v1, c.v2}) {
        for (VertexId n : neighbours_[end]) {
          if (n == c.v1 || n == c.v2 || !ends.contains(n)) continue;
          ASSERT_NE(hierarchy_.placement, Placement::kPyramid) << "adjacent collapses";
          ASSERT_EQ(region[n], region[end]) << "adjacent across regions";
        }
      }
    }
  }

  Vec3i expected_target(const Collapse& c, std::uint32_t level) const {
    const auto last = static_cast<std::uint32_t>(hierarchy_.levels.size());
    const std::int32_t parity = level_parity(level, last);
    if (hierarchy_.placement == Placement::kMidpoint) {
      return merge(c.p1, c.p2, midpoint_term(parity));
    }
    std::vector<Vec3i> opposite, others;
    std::set<VertexId> ring = neighbours_[c.v1];
    ring.insert(neighbours_[c.v2].begin(), neighbours_[c.v2].end());
    for (VertexId v : ring) {
      if (v == c.v1 || v == c.v2) continue;
      (v == c.apex12 || v == c.apex21 ? opposite : others).push_back(positions_[v]);
    }
    return merge(c.p1, c.p2, pyramid_term(opposite, others, parity));
  }

  // Returns the third vertex of the face with the directed edge from -> to, or a virtual vertex if
  // there is no such face.
  VertexId apex(VertexId from, VertexId to) const {
    for (std::size_t f : faces_at_[from]) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (faces_[f][k] == from && faces_[f][(k + 1) % 3] == to) return faces_[f][(k + 2) % 3];
      }
    }
    return kVirtualBit;
  }

  void collapse(const Collapse& c, std::uint32_t level) {
    ASSERT_EQ(positions_[c.v1], c.p1);
    ASSERT_EQ(positions_[c.v2], c.p2);
    ASSERT_EQ(apex(c.v1, c.v2), is_virtual(c.apex12) ? kVirtualBit : c.apex12);
    ASSERT_EQ(apex(c.v2, c.v1), is_virtual(c.apex21) ? kVirtualBit : c.apex21);
    const Vec3i target = expected_target(c, level);
    for (std::size_t f : faces_at_[c.v2])
      std::replace(faces_[f].begin(), faces_[f].end(), c.v2, c.v1);
    std::erase_if(faces_,
                  [&](const Triangle& f) { return std::count(f.begin(), f.end(), c.v1) > 1; });
    link();
    positions_[c.v1] = target;
    ASSERT_LE(neighbours_[c.v1].size(), static_cast<std::size_t>(kMaxSplitValence));
  }

  const Hierarchy& hierarchy_;
  std::vector<Triangle> faces_;
  std::vector<Vec3i> positions_;
  std::vector<std::set<VertexId>> neighbours_;
  std::vector<std::vector<std::size_t>> faces_at_;
  std::uint32_t loops_;  // number of boundary loops of the remaining components
};

struct SimplifyCase {
  const char* name;
  TriangleMesh mesh;
  SimplifyOptions options;
  std::uint32_t specks = 0;
};

std::vector<SimplifyCase> cases() {
  std::vector<SimplifyCase> all;
  for (const Placement placement : {Placement::kMidpoint, Placement::kPyramid}) {
    for (const std::uint32_t region_vertices : {0u, 130u}) {
      const SimplifyOptions options{
          .placement = placement, .target_vertices = 40, .region_vertices = region_vertices};
      all.push_back({"sheet", sheet(24, 20), options});
      all.push_back({"tube", tube(24, 18), options});
      all.push_back({"torus", torus(30, 16), options});
      all.push_back({"sheet with specks", sheet(24, 20), options, 60});
    }
    all.push_back({"heap",
                   tube(24, 18),
                   {.placement = placement, .order = CollapseOrder::kHeap, .target_vertices = 40}});
  }
  return all;
}

TEST(Simplify, EveryLevelIsAManifoldThatObeysTheRulesDownToTheBase) {
  for (const SimplifyCase& c : cases()) {
    SCOPED_TRACE(std::string(c.name) + " pyramid " +
                 std::to_string(c.options.placement == Placement::kPyramid) + " regions " +
                 std::to_string(c.options.region_vertices));
    LatticeMesh fine = on_lattice(c.mesh);
    add_specks(fine, c.specks, 1);
    const auto hierarchy = simplify(fine, c.options);
    ASSERT_TRUE(hierarchy.has_value());
    ASSERT_GE(hierarchy->levels.size(), 3u);
    EXPECT_EQ(c.specks > 0, std::ranges::any_of(hierarchy->insertions, [](const auto& components) {
                return !components.empty();
              }));
    Replay replay(fine, *hierarchy);
    for (std::size_t level = hierarchy->levels.size(); level >= 1; --level) {
      SCOPED_TRACE("level " + std::to_string(level));
      ASSERT_NO_FATAL_FAILURE(replay.collapse_level(static_cast<std::uint32_t>(level)));
      ASSERT_NO_FATAL_FAILURE(replay.check_manifold());
    }
    std::vector<Triangle> base;
    for (const Triangle& f : hierarchy->base.faces) {
      base.push_back(
          {hierarchy->base_ids[f[0]], hierarchy->base_ids[f[1]], hierarchy->base_ids[f[2]]});
    }
    EXPECT_EQ(canonical(base), canonical(replay.faces()));
    for (std::size_t i = 0; i < hierarchy->base_ids.size(); ++i) {
      EXPECT_EQ(hierarchy->base.positions[i], replay.positions()[hierarchy->base_ids[i]]);
    }
  }
}

TEST(Simplify, ColoursMergeAndStayExactInTheRecord) {
  TriangleMesh mesh = sheet(20, 16);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.attributes.colours.push_back({static_cast<std::uint8_t>(i * 7),
                                       static_cast<std::uint8_t>(i * 13),
                                       static_cast<std::uint8_t>(i * 29)});
  }
  const auto hierarchy = simplify(on_lattice(mesh), {.target_vertices = 40});
  ASSERT_TRUE(hierarchy.has_value());
  std::vector<Vec3i> colour = lattice_attributes(mesh.attributes)[0].values;
  for (auto level = hierarchy->levels.rbegin(); level != hierarchy->levels.rend(); ++level) {
    for (const Collapse& c : *level) {
      ASSERT_EQ(c.a1[0], colour[c.v1]);
      ASSERT_EQ(c.a2[0], colour[c.v2]);
      colour[c.v1] = merge_values(c.a1[0], c.a2[0]);
    }
  }
  const std::vector<Vec3i>& base_colours = hierarchy->base_attributes[0].values;
  ASSERT_EQ(base_colours.size(), hierarchy->base.positions.size());
  for (std::size_t i = 0; i < hierarchy->base_ids.size(); ++i) {
    EXPECT_EQ(base_colours[i], colour[hierarchy->base_ids[i]]);
  }
}

TEST(Simplify, GivesTheSameHierarchyEveryTime) {
  const LatticeMesh fine = on_lattice(torus(40, 24));
  const auto once = simplify(fine, {}), again = simplify(fine, {});
  ASSERT_EQ(once->levels.size(), again->levels.size());
  for (std::size_t l = 0; l < once->levels.size(); ++l) {
    ASSERT_EQ(once->levels[l].size(), again->levels[l].size());
    for (std::size_t i = 0; i < once->levels[l].size(); ++i) {
      ASSERT_EQ(once->levels[l][i].v1, again->levels[l][i].v1);
      ASSERT_EQ(once->levels[l][i].v2, again->levels[l][i].v2);
    }
  }
}

TEST(Simplify, RimsKeepTheirPlace) {
  const auto hierarchy = simplify(on_lattice(tube(64, 40)), {.target_vertices = 100});
  ASSERT_TRUE(hierarchy.has_value());
  const auto [low, high] =
      std::minmax_element(hierarchy->base.positions.begin(), hierarchy->base.positions.end(),
                          [](const Vec3i& a, const Vec3i& b) { return a.z < b.z; });
  const std::uint32_t shift = hierarchy->shift[0];
  const std::int32_t tolerance = 2 + (1 << shift) / 2;
  EXPECT_LE(middle_of(*low, shift).z, tolerance);
  EXPECT_GE(middle_of(*high, shift).z, 4095 - tolerance);
}

// Returns the rms distance of the vertices from the plane 3 z = x + y, in lattice units.
double off_plane(const LatticeMesh& mesh) {
  double sum = 0;
  for (const Vec3i& p : mesh.positions)
    sum += std::pow(3 * p.z - p.x - p.y, 2) / 11;
  return std::sqrt(sum / static_cast<double>(mesh.positions.size()));
}

TEST(Simplify, TakesMidpointsThatRoundOntoTheSurface) {
  TriangleMesh plane = sheet(60, 60);
  for (Vec3& p : plane.positions)
    p = {p.x * 7.3, p.y * 7.7, (p.x * 7.3 + p.y * 7.7) / 3};
  const LatticeMesh fine = quantise(plane, {.origin = {}, .step = 1, .bits = 12});
  // Midpoints are rounded differently at levels of even and odd number. 1,800 vertices take one
  // level and 1,200 take two, so both cases are tested.
  for (const std::uint32_t vertices : {1800u, 1200u}) {
    const auto hierarchy = simplify(fine, {.target_vertices = vertices}, plane.positions);
    EXPECT_LT(off_plane(hierarchy.value().base), 0.9 * off_plane(fine)) << vertices;
  }
}

Surface surface_of(const LatticeMesh& fine) {
  Surface surface;
  surface.mesh =
      *Connectivity::close(static_cast<std::uint32_t>(fine.positions.size()), fine.faces);
  surface.position = fine.positions;
  surface.quadric =
      surface_quadrics(surface.mesh, [&](VertexId v) { return to_vec3(fine.positions[v]); });
  return surface;
}

// Returns the cost of collapsing the edge to `target`, for an edge of the finest level.
double cost_of(const Surface& surface, const EdgeStar& edge, const Vec3i& target) {
  const Vec3 at = to_vec3(target);
  return surface.quadric[edge.v1].at(at) + surface.quadric[edge.v2].at(at);
}

double least_cost(const Surface& surface, Placement placement) {
  double least = std::numeric_limits<double>::infinity();
  for (Corner c = 0; c < 3 * surface.mesh.face_count(); ++c) {
    if (is_virtual(surface.mesh.vertex(c)) || is_virtual(surface.mesh.vertex(next(c)))) continue;
    const EdgeStar edge(surface.mesh, c);
    if (!keeps_manifold(surface.mesh, edge)) continue;
    const Vec3i target = merged_position(surface, edge, placement, 0);
    if (keeps_orientation(surface, edge, target))
      least = std::min(least, cost_of(surface, edge, target));
  }
  return least;
}

double cost_of(const Surface& surface, const Collapse& collapse, Placement placement) {
  for (Corner c = 0; c < 3 * surface.mesh.face_count(); ++c) {
    if (surface.mesh.vertex(c) != collapse.v1 || surface.mesh.vertex(next(c)) != collapse.v2)
      continue;
    const EdgeStar edge(surface.mesh, c);
    return cost_of(surface, edge, merged_position(surface, edge, placement, 0));
  }
  return std::numeric_limits<double>::quiet_NaN();
}

TEST(Simplify, TheHeapTakesTheCheapestPairFirst) {
  for (const TriangleMesh& mesh : {sheet(24, 20), tube(24, 18), torus(30, 16)}) {
    for (const Placement placement : {Placement::kMidpoint, Placement::kPyramid}) {
      const LatticeMesh fine = on_lattice(mesh);
      const auto vertices = static_cast<std::uint32_t>(fine.positions.size());
      const auto hierarchy = simplify(
          fine,
          {.placement = placement, .order = CollapseOrder::kHeap, .target_vertices = vertices - 1});
      ASSERT_TRUE(hierarchy.has_value());
      ASSERT_EQ(hierarchy->levels.size(), 1u);
      ASSERT_EQ(hierarchy->levels[0].size(), 1u);
      const Surface surface = surface_of(fine);
      EXPECT_EQ(cost_of(surface, hierarchy->levels[0][0], placement),
                least_cost(surface, placement));
    }
  }
}

TEST(Simplify, TheHeapLeavesWhatCarriesShapeToTheLast) {
  // A sheet that is flat except for one bump.
  TriangleMesh bumped = sheet(30, 30);
  for (Vec3& p : bumped.positions)
    p.z = 0;
  const VertexId bump = 15 * 30 + 15;
  bumped.positions[bump].z = 3;
  const LatticeMesh fine = on_lattice(bumped);
  const auto hierarchy = simplify(
      fine, {.order = CollapseOrder::kHeap, .target_vertices = 60, .region_vertices = 200});
  ASSERT_TRUE(hierarchy.has_value());
  EXPECT_EQ(hierarchy->tree.leaves(), 1u);
  const auto& base = hierarchy->base.positions;
  EXPECT_LT(base.size(), 300u);
  EXPECT_NE(std::find(base.begin(), base.end(), fine.positions[bump]), base.end());
}

TEST(Simplify, NeedlesAreNotCutWhereFlatPartsCanGo) {
  constexpr std::uint32_t kSide = 30;
  TriangleMesh needles = sheet(kSide, kSide);
  const double edge = length(needles.positions[1] - needles.positions[0]);
  const auto is_tip = [](VertexId v) { return v / kSide % 3 == 1 && v % kSide % 3 == 1; };
  for (VertexId v = 0; v < kSide * kSide; ++v)
    needles.positions[v].z = is_tip(v) ? 3 * edge : 0;
  const auto hierarchy = simplify(on_lattice(needles), {.target_vertices = 60});
  ASSERT_TRUE(hierarchy.has_value());
  EXPECT_GT(hierarchy->levels.back().size(), kSide * kSide / 10);
  for (const Collapse& c : hierarchy->levels.back())
    EXPECT_FALSE(is_tip(c.v1) || is_tip(c.v2));
}

TEST(Simplify, FacesWithoutAreaCollapseToo) {
  LatticeMesh flat = on_lattice(sheet(40, 40));
  for (Vec3i& p : flat.positions)
    p = {p.x / 400, p.y / 400, 0};
  const auto hierarchy = simplify(flat, {.target_vertices = 200});
  ASSERT_TRUE(hierarchy.has_value());
  EXPECT_LT(hierarchy->base.positions.size(), 800u);
}

TEST(Simplify, LeavesWhatCannotCollapseAsItIs) {
  const LatticeMesh tetrahedron{.lattice = {},
                                .positions = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}},
                                .faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
                                .attributes = {}};
  const auto hierarchy = simplify(tetrahedron, {.target_vertices = 1});
  ASSERT_TRUE(hierarchy.has_value());
  EXPECT_TRUE(hierarchy->levels.empty());
  EXPECT_EQ(hierarchy->base.faces.size(), 4u);
  EXPECT_EQ(hierarchy->tree.leaves(), 1u);
}

TEST(Simplify, ReportsProgressUpwards) {
  std::vector<double> seen;
  const SimplifyOptions options{.progress = [&](double f) { seen.push_back(f); }};
  ASSERT_TRUE(simplify(on_lattice(torus(40, 40)), options).has_value());
  ASSERT_FALSE(seen.empty());
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_LE(seen.back(), 1);
}

TEST(Simplify, RefusesBadFaces) {
  const LatticeMesh fine = on_lattice(torus(8, 6));
  LatticeMesh broken = fine;
  broken.faces.push_back(broken.faces.front());
  EXPECT_EQ(simplify(broken, {}).error().code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace vitrine::test
