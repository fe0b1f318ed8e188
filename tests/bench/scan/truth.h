// SPDX-License-Identifier: Apache-2.0
// Reads the ground truth that `vitrine-rig --write-truth` writes.
#pragma once

#include <filesystem>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

struct Truth {
  TriangleMesh mesh;               // positions in the table's coordinates, in mm
  std::vector<std::uint8_t> seen;  // one flag per vertex: whether laser and camera see it
};

// Reads a ground-truth file. Throws if it is not a mesh or has no `seen` flags.
Truth read_truth(const std::filesystem::path& path);

// Returns the faces whose vertices are all seen.
TriangleMesh seen_part(const Truth& truth);

}  // namespace vitrine::bench
