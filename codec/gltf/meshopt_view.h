// SPDX-License-Identifier: Apache-2.0
// Decodes glTF buffer views compressed with EXT_meshopt_compression.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/gltf/gltf_json.h"

namespace vitrine::inline codec {

// Returns the decompressed bytes of a view; each element has as many bytes as the extension's
// byteStride. `extension` is the extension's JSON object in the view. `compressed` holds the bytes
// to which the extension refers. meshoptimizer's decoders are safe on untrusted bytes. The result
// may be at most 64 times as large as `compressed`; valid data never needs more. This is checked
// before memory is allocated. Fails (kBadInput, kUnsupported) with the fault only; the caller adds
// the place.
Expected<std::vector<std::uint8_t>> decode_meshopt(const Json& extension,
                                                   std::span<const std::uint8_t> compressed);

}  // namespace vitrine::inline codec
