// SPDX-License-Identifier: Apache-2.0
// The mesh during simplification: its connectivity, and arrays indexed by vertex of the fine mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "codec/format/cell.h"
#include "codec/format/lattice_attributes.h"
#include "codec/mesh/connectivity.h"
#include "codec/mesh/triangle_mesh.h"
#include "codec/simplify/quadric.h"

namespace vitrine::inline codec {

// Returns the position of a non-virtual vertex, in lattice units.
using PositionOf = std::function<Vec3(VertexId)>;

struct Surface {
  Connectivity mesh;
  // Per vertex: its cell, with sides of 2^shift lattice units (codec/format/cell.h).
  std::vector<Vec3i> position;
  std::uint32_t shift = 0;
  LatticeAttributes attributes;
  std::vector<Quadric> quadric;
  std::vector<std::uint16_t> region;
  std::vector<VertexId> live;  // vertices that still exist, in ascending order

  // Returns the exact middle of a cell, in lattice units.
  Vec3 middle(const Vec3i& cell) const {
    const double offset = display_offset(shift);
    return to_vec3(middle_of(cell, shift)) + Vec3{offset, offset, offset};
  }
  Vec3 point(VertexId v) const { return middle(position[v]); }
};

// Returns the quadric of each vertex [GH97]: the sum of its faces' planes, weighted by area. Border
// edges add planes perpendicular to their faces, so that borders do not erode.
std::vector<Quadric> surface_quadrics(const Connectivity& mesh, const PositionOf& position);

}  // namespace vitrine::inline codec
