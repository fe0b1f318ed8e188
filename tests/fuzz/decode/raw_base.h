// SPDX-License-Identifier: Apache-2.0
// Reads and writes a `.pmesh` whose base mesh is plain little-endian integers instead of a Draco
// buffer. A fuzzer can then reach the refiner with hostile base meshes, without Draco.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/format/base_mesh.h"
#include "codec/format/manifest.h"

namespace vitrine::fuzz {

// Returns the positions, faces and attributes of level 0. In `bytes`, each position, face and
// attribute value is three 32-bit integers. The result is incomplete if bytes are missing.
BaseMesh read_raw_base(std::span<const std::uint8_t> bytes, const Manifest& manifest);

// Returns the file `pmesh`, with `base` in raw form as its base mesh. Both must be valid, and
// `manifest` must be the manifest of the file.
std::vector<std::uint8_t> with_raw_base(std::span<const std::uint8_t> pmesh, Manifest manifest,
                                        const BaseMesh& base);

}  // namespace vitrine::fuzz
