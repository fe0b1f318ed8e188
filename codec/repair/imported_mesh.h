// SPDX-License-Identifier: Apache-2.0
// The mesh type that readers return and repair() accepts.
#pragma once

#include <string>
#include <vector>

#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// The mesh of a file, with polygons cut into triangles. Every index is in range. Positions used by
// faces are finite. The mesh need not be a manifold (see repair.h).
struct ImportedMesh {
  TriangleMesh mesh;                 // positions in model units
  std::string unit;                  // a name in kLengthUnits, or empty if unknown
  std::vector<std::string> repairs;  // one line for each kind of change made by the reader
  Texturing texturing;  // texturing of `mesh`; vertex colours may come from its pictures
};

}  // namespace vitrine::inline codec
