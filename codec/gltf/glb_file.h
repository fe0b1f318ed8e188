// SPDX-License-Identifier: Apache-2.0
// The container of binary glTF 2.0: a JSON document and a chunk of binary data.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine::inline codec {

// Parts of the input. Each may be empty.
struct GlbChunks {
  std::string_view json;
  std::span<const std::uint8_t> binary;
};

// Finds the chunks of a GLB file. Fails (kBadInput, kUnsupported) if the version of the container
// is not supported or a chunk is cut short.
Expected<GlbChunks> split_glb(std::span<const std::uint8_t> bytes);

}  // namespace vitrine::inline codec
