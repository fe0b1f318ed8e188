// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/surface_points.h"

#include <algorithm>
#include <cmath>

#include "codec/mesh/closest_point.h"
#include "codec/mesh/vertex_normals.h"

namespace vitrine::acquisition {
namespace {

using Cube = std::array<std::int64_t, 3>;

Cube cube_of(const Vec3& p, double side) {
  const auto index = [side](double x) { return static_cast<std::int64_t>(std::floor(x / side)); };
  return {index(p.x), index(p.y), index(p.z)};
}

// Adds the mean of `vertices` to `points`, unless the sum of their normals is zero.
void add_mean(SurfacePoints& points, const TriangleMesh& mesh, const std::vector<Vec3>& normals,
              std::span<const std::pair<Cube, std::uint32_t>> vertices) {
  Vec3 at, normal;
  for (const auto& [cube, v] : vertices)
    at += mesh.positions[v], normal += normals[v];
  const double size = length(normal);
  if (!(size > 0)) return;
  points.at.push_back(at * (1 / static_cast<double>(vertices.size())));
  points.normals.push_back(normal * (1 / size));
}

}  // namespace

double area_of(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& f : mesh.faces)
    area +=
        length(normal_of({mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]]})) / 2;
  return area;
}

SurfacePoints evenly_spaced(const TriangleMesh& mesh, double spacing) {
  const std::vector<Vec3> normals = vertex_normals(mesh);
  std::vector<std::pair<Cube, std::uint32_t>> placed;
  placed.reserve(mesh.positions.size());
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
    placed.emplace_back(cube_of(mesh.positions[v], spacing), v);
  std::ranges::sort(placed);
  SurfacePoints points;
  for (std::size_t first = 0, last = 0; first < placed.size(); first = last) {
    while (last < placed.size() && placed[last].first == placed[first].first)
      ++last;
    add_mean(points, mesh, normals, std::span(placed).subspan(first, last - first));
  }
  return points;
}

PointGrid::PointGrid(const std::vector<Vec3>& points, double reach)
    : points_(points), reach_(reach) {
  placed_.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    placed_.push_back({cell_of(points[i]), i});
  std::ranges::sort(placed_);
}

PointGrid::Cell PointGrid::cell_of(const Vec3& p) const {
  return cube_of(p, reach_);
}

void PointGrid::near(const Vec3& p, const std::function<void(std::uint32_t)>& found) const {
  const Cell middle = cell_of(p);
  for (std::int64_t x = -1; x <= 1; ++x) {
    for (std::int64_t y = -1; y <= 1; ++y) {
      // Cells that are adjacent in z are consecutive in memory.
      const Cell low = {middle[0] + x, middle[1] + y, middle[2] - 1};
      const Cell high = {low[0], low[1], low[2] + 2};
      for (auto at = std::ranges::lower_bound(placed_, Placed{low, 0});
           at != placed_.end() && at->cell <= high; ++at) {
        const Vec3 d = points_[at->point] - p;
        if (dot(d, d) <= reach_ * reach_) found(at->point);
      }
    }
  }
}

}  // namespace vitrine::acquisition
