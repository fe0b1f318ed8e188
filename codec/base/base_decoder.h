// SPDX-License-Identifier: Apache-2.0
// Decodes the base mesh of a `.pmesh` from its Draco buffer.
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/expected.h"
#include "codec/format/base_mesh.h"
#include "codec/format/manifest.h"

namespace vitrine::inline codec {

// Decodes the Draco buffer `bytes`. Fails (kBadInput) if it does not match `manifest`: the geometry
// type and the method are checked before decoding, the counts afterwards. Draco is not safe on
// hostile bytes, so call this in a sandbox unless this codec wrote the bytes.
Expected<BaseMesh> decode_base(std::span<const std::uint8_t> bytes, const Manifest& manifest);

}  // namespace vitrine::inline codec
