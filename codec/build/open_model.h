// SPDX-License-Identifier: Apache-2.0
// Opens a `.pmesh`, given as bytes in memory, for refinement.
#pragma once

#include <cstdint>
#include <span>

#include "codec/build/refine.h"

namespace vitrine::inline codec {

// Parses the header, checks the SHA-256 of the base mesh and decodes it. Returns a refiner at level
// 0. Chunks at the end of `pmesh` may be missing. Fails with the error of parse_header(), or with
// kBadInput if the base mesh is damaged. Draco, which decodes the base mesh, is not safe on hostile
// bytes: call this in a sandbox for files from others.
Expected<Refiner> open_model(std::span<const std::uint8_t> pmesh);

// Returns a function that reads chunks of `pmesh` and checks their SHA-256. Both arguments must
// outlive the function.
ChunkReader chunks_of(const Manifest& manifest, std::span<const std::uint8_t> pmesh);

}  // namespace vitrine::inline codec
