// SPDX-License-Identifier: Apache-2.0
// What `vitrine-rig --write-truth` says of the object on its table.
#pragma once

#include <filesystem>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

struct Truth {
  TriangleMesh mesh;               // mm, the table's frame
  std::vector<std::uint8_t> seen;  // a vertex: by laser and camera
};

// Throws where it is not such a file.
Truth read_truth(const std::filesystem::path& path);

// The faces all of whose vertices are seen.
TriangleMesh seen_part(const Truth& truth);

}  // namespace vitrine::bench
