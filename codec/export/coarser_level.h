// SPDX-License-Identifier: Apache-2.0
// A coarser level of detail for a file that holds several levels (ExportOptions::coarser).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/core/vec.h"
#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// The grid to which a compressed file may round positions: origin + step * integer, in the
// positions' unit.
struct ExportGrid {
  Vec3 origin;
  double step = 1;  // > 0 and finite
};

struct CoarserLevel {
  TriangleMesh mesh;  // in the unit of the finest mesh
  // Texture coordinates of the faces' corners. Empty if the finest mesh has no texture.
  std::vector<std::array<TextureCoordinates, 3>> coordinates;
  std::uint32_t level = 0;  // number of the level of detail
  double error = 0;         // upper bound of the error, in the positions' unit
  ExportGrid grid;
};

}  // namespace vitrine::inline codec
