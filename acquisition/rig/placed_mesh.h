// SPDX-License-Identifier: Apache-2.0
// The object as it stands on the table.
#pragma once

#include <filesystem>
#include <string>

#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::rig {

struct PlacedMesh {
  std::filesystem::path file;  // any format of codec/import
  double height_mm = 80;
  std::string up = "y";  // the file's axis that points upwards: x, y, z, -x, -y or -z
};

// In mm in the table's frame at 0 degrees: z upwards, the lowest point at 0, the middle of its
// bounding box over the axis. Fails where the file cannot be read or has no height.
Expected<TriangleMesh> load(const PlacedMesh& placed);

}  // namespace vitrine::rig
