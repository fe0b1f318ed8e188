// SPDX-License-Identifier: Apache-2.0
// Tests keeps_near() for each edge of a bumpy sheet. Its result must agree with the measured
// distances between the surfaces before and after the edge's collapse.
#include "codec/simplify/closeness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "codec/mesh/triangle_bvh.h"
#include "support/meshes.h"

namespace vitrine::test {
namespace {

constexpr double kReach = 12.3;  // in lattice units; no distance in the tests is exactly this long

// Returns a sheet with bumps. `height` is the height of the bumps, in edge lengths.
Surface bumpy_sheet(double height) {
  constexpr std::uint32_t kSide = 24;
  TriangleMesh sheet = test::sheet(kSide, kSide);
  const double edge = length(sheet.positions[1] - sheet.positions[0]);
  for (VertexId v = 0; v < kSide * kSide; ++v)
    sheet.positions[v].z = edge * height * std::sin(v * v * 0.37);
  const LatticeMesh fine = quantise(sheet, fit_lattice(sheet.positions, 10));
  Surface surface{.mesh = *Connectivity::close(kSide * kSide, fine.faces),
                  .position = fine.positions};
  for (VertexId v = 0; v < kSide * kSide; ++v)
    surface.live.push_back(v);
  return surface;
}

// The faces around an edge, before or after its collapse. `edges` holds the midpoints of all edges
// at the two ends. `faces` holds the centroids of the faces.
struct EdgeFaces {
  TriangleMesh mesh;
  std::vector<Vec3> edges, faces;
};

EdgeFaces around(const Surface& surface, const EdgeStar& edge, const Vec3* target) {
  EdgeFaces out;
  std::set<std::uint32_t> done;
  for (const Star* star : {&edge.star1, &edge.star2}) {
    for (std::uint32_t i = 0; i < star->valence; ++i) {
      const std::uint32_t face = star->corner[i] / 3;
      Triangle t;
      std::vector<Vec3> p;
      std::uint32_t ends = 0, real = 0;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const VertexId v = surface.mesh.vertex(3 * face + k);
        const bool end = v == edge.v1 || v == edge.v2;
        ends += end;
        if (is_virtual(v)) continue;
        ++real;
        p.push_back(end && target != nullptr ? *target : surface.point(v));
      }
      const VertexId other = star->vertex[i], centre = surface.mesh.vertex(star->corner[i]);
      const bool same = other == edge.v1 || other == edge.v2;
      if (!is_virtual(other) && !(same && target != nullptr)) {
        const Vec3 from = target != nullptr ? *target : surface.point(centre);
        out.edges.push_back((from + surface.point(other)) * 0.5);
      }
      if (real < 3 || (target != nullptr && ends == 2) || !done.insert(face).second) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        t[k] = static_cast<VertexId>(out.mesh.positions.size());
        out.mesh.positions.push_back(p[k]);
      }
      out.mesh.faces.push_back(t);
      out.faces.push_back((p[0] + p[1] + p[2]) * (1.0 / 3));
    }
  }
  return out;
}

double farthest(const std::vector<Vec3>& points, const TriangleBvh& from) {
  double most = 0;
  for (const Vec3& p : points)
    most = std::max(most, std::sqrt(from.closest(p).squared));
  return most;
}

struct DistanceCounts {
  std::size_t near = 0, far_ends = 0, far_middles = 0;
};

DistanceCounts compare_all(const Surface& surface) {
  DistanceCounts count;
  for (Corner c = 0; c < 3 * surface.mesh.face_count(); ++c) {
    if (is_virtual(surface.mesh.vertex(c)) || is_virtual(surface.mesh.vertex(next(c)))) continue;
    const EdgeStar edge(surface.mesh, c);
    if (!keeps_manifold(surface.mesh, edge)) continue;
    const Vec3i target = merged_position(surface, edge, Placement::kMidpoint, 0);
    const Vec3 to = surface.middle(target);
    const EdgeFaces before = around(surface, edge, nullptr), after = around(surface, edge, &to);
    const TriangleBvh old_faces(before.mesh), new_faces(after.mesh);
    const double ends = farthest({surface.point(edge.v1), surface.point(edge.v2)}, new_faces);
    const double middles =
        std::max({farthest(before.edges, new_faces), farthest(after.edges, old_faces),
                  farthest(after.faces, old_faces)});
    EXPECT_EQ(keeps_near(surface, edge, target, kReach), std::max(ends, middles) <= kReach)
        << "edge of " << edge.v1 << " and " << edge.v2 << ": " << ends << ", " << middles;
    count.far_ends += ends > kReach, count.far_middles += ends <= kReach && middles > kReach;
    count.near += std::max(ends, middles) <= kReach;
  }
  return count;
}

TEST(Closeness, ComparesTheSurfacesBeforeAndAfter) {
  const DistanceCounts count = compare_all(bumpy_sheet(0.8));
  EXPECT_GT(count.near, 100u);
  EXPECT_GT(count.far_ends, 100u);
  EXPECT_GT(count.far_middles, 10u);
}

// The bumps are about as high as kReach. Some patches therefore fit into a slab of this thickness,
// and others do not.
TEST(Closeness, ComparesFlatSurfacesToo) {
  const DistanceCounts count = compare_all(bumpy_sheet(0.3));
  EXPECT_GT(count.near, 100u);
  EXPECT_GT(count.far_ends, 10u);
}

}  // namespace
}  // namespace vitrine::test
