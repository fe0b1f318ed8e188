// SPDX-License-Identifier: Apache-2.0
// Reads a mesh file in any format of formats.h. The format is recognised by the content, never by
// the file name.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "codec/core/expected.h"
#include "codec/core/limits.h"
#include "codec/files/companions.h"
#include "codec/repair/imported_mesh.h"

namespace vitrine::inline codec {

enum class UpAxis { kY, kZ };

struct ReadOptions {
  Limits limits = {};
  // One of kLengthUnits, which overrides the file's own unit. Empty: use the file's own unit.
  std::string_view unit = {};
  UpAxis up = UpAxis::kY;  // kZ: the file's z axis points up; it is turned to y
  Companions beside = {};  // files to which the mesh file may refer
};

// Returns the unit stated by the standard of the file's format or by a comment in the file
// (unit_comment.h). Returns an empty text if there is none.
std::string_view stated_unit(std::span<const std::uint8_t> bytes);

// Reads a mesh. Call this in the sandbox if the bytes are untrusted, because the decoders of Draco
// data and pictures are not safe. Fails (kBadInput, kUnsupported, kLimit) with the place of the
// fault.
//
// Allocates at most about 64 times the size of the input with the files beside it, or 128 times for
// glTF, which may repeat its meshes. Compressed parts and pictures are counted with their decoded
// size: at most 1024 bytes or pixels per byte, 4096 x 4096 pixels in a WebP of any size, and
// `limits.pixels` pixels in all. Apart from these WebP pictures, a count in the file alone never
// causes an allocation.
Expected<ImportedMesh> read_mesh(std::span<const std::uint8_t> bytes,
                                 const ReadOptions& options = {});

}  // namespace vitrine::inline codec
