// SPDX-License-Identifier: Apache-2.0
// Reads the mesh of the simulated object and places it on the table.
#pragma once

#include <filesystem>
#include <string>

#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::acquisition::rig {

struct ObjectFile {
  std::filesystem::path file;  // in any format that codec/import reads
  double height_mm = 80;
  std::string up = "y";  // the file's upward axis: x, y, z, -x, -y or -z
};

// Reads the mesh and places it on the table. The result is in mm in the table's frame at 0 degrees:
// z points upwards, the lowest point is at 0, and the centre of the bounding box is on the axis.
// Fails if the file cannot be read or has no height.
Expected<TriangleMesh> load(const ObjectFile& placed);

}  // namespace vitrine::acquisition::rig
