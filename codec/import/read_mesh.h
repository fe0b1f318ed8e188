// SPDX-License-Identifier: Apache-2.0
// Reads a mesh file: PLY, OBJ, STL, OFF or GLB, told apart by content and never by name.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/limits.h"
#include "codec/import/companions.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

enum class UpAxis { kY, kZ };

// What to make of a file beyond what its bytes say.
struct ReadOptions {
  Limits limits = {};
  std::string_view unit =
      {};                  // of kLengthUnits, instead of what the file states; empty: none given
  UpAxis up = UpAxis::kY;  // kZ: the file's z axis points up and is turned to y
  Companions beside = {};  // files that an OBJ or PLY may name: colours come out of them
};

// A mesh as its file has it, polygons cut into triangles: every index is in range and every
// position that a face uses is finite; the topology may be anything (see repair.h).
struct ImportedMesh {
  TriangleMesh mesh;                 // model units of the file
  std::string unit;                  // of kLengthUnits; empty where it is unknown
  std::vector<std::string> repairs;  // what was left out or changed, one line each
};

// The unit that a file states: GLB is in metres by its standard; the other formats may state one in
// a comment (see unit_comment.h). Empty where there is none.
std::string_view stated_unit(std::span<const std::uint8_t> bytes);

// For untrusted bytes, but in the sandbox: the decoders of
// Draco data and of pictures are not safe. Allocates at most about 64 times the input, for
// GLB, which may repeat its meshes, 128 times, where a compressed part or a picture counts as what
// it makes (at most 1024 bytes or pixels for each of its own), and nothing on the word of a count
// alone. Fails (kBadInput, kUnsupported, kLimit) with the place of the fault.
Expected<ImportedMesh> read_mesh(std::span<const std::uint8_t> bytes,
                                 const ReadOptions& options = {});

}  // namespace vitrine
