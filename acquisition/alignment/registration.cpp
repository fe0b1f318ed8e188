// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/registration.h"

#include <cmath>

#include "acquisition/alignment/rigid_pose.h"
#include "codec/mesh/face_neighbours.h"
#include "codec/mesh/vertex_normals.h"

namespace vitrine::acquisition {
namespace {

constexpr double kCosAgree = .5;     // smallest cosine between the two normals of a pair of points
constexpr std::size_t kFewest = 12;  // smallest number of pairs: twice the number of unknowns

}  // namespace

SurfacePoints some_vertices(const TriangleMesh& mesh, std::size_t count) {
  const std::vector<Vec3> normals = unit_normals(mesh);
  SurfacePoints some;
  const std::size_t step = mesh.positions.size() / count + 1;
  for (std::size_t i = 0; i < mesh.positions.size(); i += step)
    some.at.push_back(mesh.positions[i]), some.normals.push_back(normals[i]);
  return some;
}

FixedSurface::FixedSurface(const TriangleMesh& mesh) : bvh_(mesh), rim_(bvh_.size(), false) {
  const auto across = face_neighbours(bvh_.faces(), bvh_.positions().size());
  for (std::uint32_t t = 0; t < bvh_.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k)
      rim_[t] = rim_[t] || across[t][k] == 3 * t + k;
  }
}

std::vector<Counterpart> FixedSurface::counterparts(const SurfacePoints& points,
                                                    const RigidMotion& motion, double reach) const {
  std::vector<Counterpart> found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 moved = motion(points.at[i]);
    const ClosestTriangle hit = bvh_.closest(moved, {reach * reach});
    if (hit.squared >= reach * reach || rim_[hit.triangle]) continue;
    const TrianglePoints corners = bvh_.triangle(hit.triangle);
    const Vec3 normal = normal_of(corners);
    const double size = length(normal);
    if (!(size > 0) || dot(normal, turned(motion, points.normals[i])) < kCosAgree * size) continue;
    found.push_back({moved, closest_point(corners, moved), normal * (1 / size)});
  }
  return found;
}

double rms_of(std::span<const Counterpart> pairs) {
  double sum = 0;
  for (const Counterpart& pair : pairs) {
    const double d = dot(pair.on - pair.point, pair.normal);
    sum += d * d;
  }
  return pairs.empty() ? 0 : std::sqrt(sum / static_cast<double>(pairs.size()));
}

RigidMotion register_points(const SurfacePoints& points, const FixedSurface& surface,
                            RigidMotion motion, std::span<const double> reaches, int steps) {
  for (const double reach : reaches) {
    for (int step = 0; step < steps; ++step) {
      const auto pairs = surface.counterparts(points, motion, reach);
      if (pairs.size() < kFewest) return motion;
      motion = then(motion, towards_planes(pairs));
    }
  }
  return motion;
}

}  // namespace vitrine::acquisition
