// SPDX-License-Identifier: Apache-2.0
// The object as it stands on the table.
#pragma once

#include <filesystem>

#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::rig {

struct PlacedMesh {
  std::filesystem::path file;  // any format of codec/import
  double height_mm = 80;
  bool z_up = false;  // the file's z axis points upwards, not its y axis
};

// In mm in the table's frame at 0 degrees: z upwards, the lowest point at 0, the middle of its
// bounding box over the axis. Fails where the file cannot be read or has no height.
Expected<TriangleMesh> load(const PlacedMesh& placed);

}  // namespace vitrine::rig
