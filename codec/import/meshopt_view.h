// SPDX-License-Identifier: Apache-2.0
// Buffer views of glTF that are compressed with EXT_meshopt_compression.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/import/gltf_json.h"

namespace vitrine {

// The plain bytes of a view, byteStride for each of its elements. `extension` is the view's JSON
// object of that name, `compressed` the bytes it refers to. meshoptimizer's decoders are safe for
// untrusted bytes; the size is checked before it is allocated and is at most 64 times `compressed`
// (no valid data is denser). Fails (kBadInput, kUnsupported) with the fault alone: the caller adds
// the place.
Expected<std::vector<std::uint8_t>> decode_meshopt(const Json& extension,
                                                   std::span<const std::uint8_t> compressed);

}  // namespace vitrine
