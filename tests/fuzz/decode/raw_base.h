// SPDX-License-Identifier: Apache-2.0
// A `.pmesh` whose base mesh is plain little-endian integers instead of a Draco buffer, so that a
// fuzzer reaches the refiner with hostile base meshes and Draco stays outside.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/progressive/base_mesh.h"
#include "codec/progressive/manifest.h"

namespace vitrine::fuzz {

// The positions, faces and colours of level 0, three 32-bit integers each; short where bytes lack.
BaseMesh read_raw_base(std::span<const std::uint8_t> bytes, const Manifest& manifest);

// The same model with a raw base mesh. Both must be valid.
std::vector<std::uint8_t> with_raw_base(std::span<const std::uint8_t> pmesh, Manifest manifest,
                                        const BaseMesh& base);

}  // namespace vitrine::fuzz
