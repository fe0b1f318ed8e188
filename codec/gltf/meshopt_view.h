// SPDX-License-Identifier: Apache-2.0
// Decodes glTF buffer views that are compressed with EXT_meshopt_compression.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/gltf/gltf_json.h"

namespace vitrine::inline codec {

// Returns the decompressed bytes of a view, byteStride bytes per element. `extension` is the JSON
// object of the extension in that view; `compressed` holds the bytes to which it refers.
// meshoptimizer's decoders are safe on untrusted bytes. The result is at most 64 times as large as
// `compressed` (valid data is never denser); this is checked before memory is allocated. Fails
// (kBadInput, kUnsupported) with the fault only; the caller adds the place.
Expected<std::vector<std::uint8_t>> decode_meshopt(const Json& extension,
                                                   std::span<const std::uint8_t> compressed);

}  // namespace vitrine::inline codec
