// SPDX-License-Identifier: Apache-2.0
// The mesh type that readers return and repair() accepts.
#pragma once

#include <string>
#include <vector>

#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// The mesh of a file, with polygons cut into triangles. Every index is in range. Every position
// that a face uses is finite. The topology is arbitrary (see repair.h).
struct ImportedMesh {
  TriangleMesh mesh;                 // in model units
  std::string unit;                  // name of one of kLengthUnits; empty if unknown
  std::vector<std::string> repairs;  // one line for each kind of part that was removed or changed
  Texturing texturing;  // of the faces of `mesh`; its pictures are also baked into colours
};

}  // namespace vitrine::inline codec
