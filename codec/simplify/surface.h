// SPDX-License-Identifier: Apache-2.0
// The mesh while it is being simplified: connectivity and side arrays, indexed by fine vertex ids.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "codec/mesh/connectivity.h"
#include "codec/mesh/triangle_mesh.h"
#include "codec/progressive/cell.h"
#include "codec/simplify/quadric.h"

namespace vitrine {

using PositionOf = std::function<Vec3(VertexId)>;  // of a real vertex, lattice units

struct Surface {
  Connectivity mesh;
  std::vector<Vec3i> position;  // cells of 2^shift (codec/progressive/cell.h)
  std::uint32_t shift = 0;
  std::vector<Vec3i> colour;  // YCoCg-R; empty where the mesh has none
  std::vector<Quadric> quadric;
  std::vector<std::uint16_t> region;
  std::vector<VertexId> live;  // ascending

  // The middle of a cell, lattice units.
  Vec3 middle(const Vec3i& cell) const {
    const double offset = display_offset(shift);
    return to_vec3(middle_of(cell, shift)) + Vec3{offset, offset, offset};
  }
  Vec3 point(VertexId v) const { return middle(position[v]); }
};

// One quadric for each real vertex: the planes of its faces weighted by area, and at the
// boundary planes through the border edges, at right angles to the face, so that rims do not erode.
std::vector<Quadric> surface_quadrics(const Connectivity& mesh, const PositionOf& position);

}  // namespace vitrine
