// SPDX-License-Identifier: Apache-2.0
// Reads a mesh file: PLY, OBJ, STL, OFF or GLB, told apart by content and never by name.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/limits.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

// A mesh as its file has it, polygons cut into triangles: every index is in range and every
// position that a face uses is finite; the topology may be anything (see repair.h).
struct ImportedMesh {
  TriangleMesh mesh;                 // model units of the file
  std::vector<std::string> repairs;  // what was left out or changed, one line each
};

// Safe for untrusted bytes. Allocates at most about 64 times the input, and nothing on the word of
// a count alone. Fails (kBadInput, kUnsupported, kLimit) with the place of the fault.
Expected<ImportedMesh> read_mesh(std::span<const std::uint8_t> bytes, const Limits& limits = {});

}  // namespace vitrine
