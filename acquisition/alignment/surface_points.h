// SPDX-License-Identifier: Apache-2.0
// Evenly spaced points of a surface with their normals, and the search for points near a position.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::acquisition {

struct SurfacePoints {
  std::vector<Vec3> at;       // positions in mm
  std::vector<Vec3> normals;  // unit vectors, towards the outside
  std::size_t size() const { return at.size(); }
};

// Returns the area of the mesh in mm².
double area_of(const TriangleMesh& mesh);

// Returns one point for each cube of a grid that contains vertices: the mean of these vertices.
// `spacing` is the side of the cubes in mm and must be positive. Takes O(n log n) time.
SurfacePoints evenly_spaced(const TriangleMesh& mesh, double spacing);

// A grid that finds points near a position. `points` must outlive the grid.
class PointGrid {
 public:
  // `reach` is the radius of all searches, in mm.
  PointGrid(const std::vector<Vec3>& points, double reach);

  // Calls `found` with the index of each point within `reach` of `p`, in a fixed order.
  void near(const Vec3& p, const std::function<void(std::uint32_t)>& found) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Placed {
    Cell cell;
    std::uint32_t point;
    auto operator<=>(const Placed&) const = default;
  };
  Cell cell_of(const Vec3& p) const;

  const std::vector<Vec3>& points_;
  double reach_;
  std::vector<Placed> placed_;
};

}  // namespace vitrine::acquisition
