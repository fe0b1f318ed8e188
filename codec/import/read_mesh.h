// SPDX-License-Identifier: Apache-2.0
// Reads a mesh file in any format of formats.h, or a package that contains such a file. Recognises
// the format by the file's content, never by its name.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "codec/core/expected.h"
#include "codec/core/limits.h"
#include "codec/files/companions.h"
#include "codec/mesh/up_axis.h"
#include "codec/repair/imported_mesh.h"

namespace vitrine::inline codec {

struct ReadOptions {
  Limits limits = {};
  // One of kLengthUnits, which overrides the unit in the file. If empty, the unit in the file
  // applies.
  std::string_view unit = {};
  UpAxis up = UpAxis::kY;  // kZ: z points up in the file; the mesh is rotated to y up
  Companions beside = {};  // contents of the files that the mesh file names
  // Name of the file, or empty. Error messages use its extension if the file's bytes do not
  // determine its kind.
  std::string_view name = {};
};

// Returns the unit that the format's standard requires or that a comment in the file states
// (unit_in_comments()). Returns an empty string if there is neither. Unpacks a package.
std::string_view stated_unit(std::span<const std::uint8_t> bytes);

// Reads a mesh. If `bytes` is a package, unpacks it and reads the one model in it, with the files
// in the package as its companions (packaged_model.h). Call this in the sandbox if the bytes are
// untrusted, because the decoders of Draco data, pictures, FBX and packages are not safe on hostile
// bytes. Fails (kBadInput, kUnsupported, kLimit); the message says where the fault is.
//
// Allocates at most about 64 times the size of the input and its companions. The factor is 128 for
// glTF, which may repeat its meshes, and for FBX, whose arrays may be compressed. A package counts
// by its unpacked size. Compressed parts and pictures count by their decoded size. Each byte
// decodes to at most 1024 bytes or pixels. A WebP of any size may have 4096 x 4096 pixels. All
// pictures together have at most `limits.pixels` pixels. Apart from these WebP pictures, a count in
// the file alone never causes an allocation.
Expected<ImportedMesh> read_mesh(std::span<const std::uint8_t> bytes,
                                 const ReadOptions& options = {});

}  // namespace vitrine::inline codec
