// SPDX-License-Identifier: Apache-2.0
// Splits a binary glTF 2.0 file (GLB) into its JSON document and its binary data.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine::inline codec {

// Parts of the GLB file. Each may be empty.
struct GlbChunks {
  std::string_view json;
  std::span<const std::uint8_t> binary;
};

// Finds the chunks of a GLB file. Fails (kBadInput, kUnsupported) if the container's version is not
// supported or a chunk is truncated.
Expected<GlbChunks> split_glb(std::span<const std::uint8_t> bytes);

}  // namespace vitrine::inline codec
