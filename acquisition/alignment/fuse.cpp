// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/fuse.h"

#include <algorithm>
#include <array>

#include "codec/mesh/triangle_bvh.h"

namespace vitrine::acquisition {
namespace {

bool is_covered(const TriangleMesh& scan, const Triangle& face, const TriangleBvh& surface,
                double reach) {
  const Vec3 &a = scan.positions[face[0]], &b = scan.positions[face[1]],
             &c = scan.positions[face[2]];
  return std::ranges::all_of(std::array{a, b, c, (a + b + c) * (1. / 3)}, [&](const Vec3& p) {
    return surface.closest(p, {reach * reach}).squared < reach * reach;
  });
}

void add_uncovered(TriangleMesh& mesh, const TriangleMesh& scan, double reach) {
  const TriangleBvh surface(mesh);
  constexpr std::uint32_t kNone = UINT32_MAX;
  std::vector<std::uint32_t> places(scan.positions.size(), kNone);
  const auto place = [&](std::uint32_t vertex) {
    if (places[vertex] == kNone) {
      places[vertex] = static_cast<std::uint32_t>(mesh.positions.size());
      mesh.positions.push_back(scan.positions[vertex]);
    }
    return places[vertex];
  };
  for (const Triangle& face : scan.faces) {
    if (!is_covered(scan, face, surface, reach))
      mesh.faces.push_back({place(face[0]), place(face[1]), place(face[2])});
  }
}

}  // namespace

TriangleMesh fused_surface(std::span<const PoseScan> scans, std::span<const RigidMotion> motions,
                           double reach) {
  TriangleMesh mesh{scans[0].mesh.positions, scans[0].mesh.faces, {}};
  for (std::size_t k = 1; k < scans.size(); ++k) {
    TriangleMesh moved = scans[k].mesh;
    for (Vec3& p : moved.positions)
      p = motions[k](p);
    add_uncovered(mesh, moved, reach);
  }
  return mesh;
}

}  // namespace vitrine::acquisition
