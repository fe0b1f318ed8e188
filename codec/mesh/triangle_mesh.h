// SPDX-License-Identifier: Apache-2.0
// The shared currency: an indexed triangle mesh in model units, and the same on the lattice.
#pragma once

#include <string>
#include <vector>

#include "codec/core/lattice.h"
#include "codec/core/vec.h"

namespace vitrine {

// `colours` is empty or has one entry per vertex. Faces are counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
  std::vector<Colour> colours;
};

// A mesh whose positions are integers on a grid. Positions may repeat and faces may have no area:
// quantisation does that, and the connectivity is kept as it is.
struct LatticeMesh {
  Lattice lattice;
  std::vector<Vec3i> positions;
  std::vector<Triangle> faces;
  std::vector<Colour> colours;
};

// Rounds the positions to `lattice`; connectivity and colours are copied.
LatticeMesh quantise(const TriangleMesh& mesh, const Lattice& lattice);

TriangleMesh to_model(const LatticeMesh& mesh);

}  // namespace vitrine
