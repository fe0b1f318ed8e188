// SPDX-License-Identifier: Apache-2.0
// Decodes the base mesh of a `.pmesh` from its Draco buffer [Draco].
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/expected.h"
#include "codec/format/base_mesh.h"
#include "codec/format/manifest.h"

namespace vitrine::inline codec {

// Decodes the Draco buffer `bytes`, which must be of the kind that FORMAT.md 1.7 describes. Fails
// (kBadInput) if the buffer is damaged or does not match `manifest`, and (kUnsupported) if Draco
// could read it but this codec never writes it. Safe on any bytes: allocates at most 1,000 bytes
// per byte of `bytes`. The faces need not be a valid mesh; Refiner::start checks them.
Expected<BaseMesh> decode_base(std::span<const std::uint8_t> bytes, const Manifest& manifest);

}  // namespace vitrine::inline codec
