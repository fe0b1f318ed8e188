// SPDX-License-Identifier: Apache-2.0
// Checks the structure of an FBX file before it is imported, because the importer (Assimp) trusts
// the nesting, the array sizes and the links of a file. Also finds data that the importer does not
// return.
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/expected.h"

namespace vitrine::inline codec {

struct FbxOutline {
  double centimetres = 1;           // length of the file's unit
  int up_axis = 1;                  // axis that points up: 0 x, 1 y, 2 z
  std::uint64_t decoded_bytes = 0;  // size of the file with its arrays decompressed
  std::uint64_t animations = 0, skins = 0, morphs = 0;
};

// Whether the bytes begin like a binary FBX file, or like a text FBX file.
bool is_binary_fbx(std::span<const std::uint8_t> bytes);
bool is_text_fbx(std::span<const std::uint8_t> bytes);

// Reads each byte once. Fails (kBadInput) in these cases:
// - The file is cut off, or its records are nested too deeply.
// - An array is larger than its bytes can encode.
// - Objects are linked in a cycle, or in a chain that is too long.
// - Models have too many instances, materials or morph targets.
Expected<FbxOutline> outline_of_fbx(std::span<const std::uint8_t> bytes);

}  // namespace vitrine::inline codec
