// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/expected.h"
#include "codec/progressive/base_mesh.h"
#include "codec/progressive/manifest.h"

namespace vitrine {

// Decodes the base mesh of a `.pmesh`. The Draco header's type and method are checked first and the
// counts afterwards, but Draco itself is not safe on hostile bytes: call it in the sandbox unless
// the bytes are known to be this codec's own.
Expected<BaseMesh> decode_base(std::span<const std::uint8_t> bytes, const Manifest& manifest);

}  // namespace vitrine
