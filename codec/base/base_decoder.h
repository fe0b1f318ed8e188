// SPDX-License-Identifier: Apache-2.0
// Decodes the base mesh of a `.pmesh` from its Draco buffer [Draco].
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/expected.h"
#include "codec/format/base_mesh.h"
#include "codec/format/manifest.h"

namespace vitrine::inline codec {

// Decodes the Draco buffer `bytes`, which must have the layout that FORMAT.md 1.7 describes. Fails
// (kBadInput) if the buffer is damaged or does not match `manifest`. Fails (kUnsupported) if it
// uses Draco features that this codec never writes. Safe on any bytes: allocates at most 1,000
// bytes per byte of `bytes`. Does not check that the faces form a valid mesh; Refiner::start does.
Expected<BaseMesh> decode_base(std::span<const std::uint8_t> bytes, const Manifest& manifest);

}  // namespace vitrine::inline codec
