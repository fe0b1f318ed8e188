// SPDX-License-Identifier: Apache-2.0
// Opens a `.pmesh` in memory, so that it can be refined.
#pragma once

#include <cstdint>
#include <span>

#include "codec/build/refine.h"

namespace vitrine::inline codec {

// Parses the header, checks the SHA-256 of the base mesh and of the atlas, and decodes both.
// Returns a refiner at level 0. `pmesh` may end before its last chunks. Fails with the error of
// parse_header(), or with kBadInput if the base mesh or the atlas is damaged. Safe on any bytes.
Expected<Refiner> open_model(std::span<const std::uint8_t> pmesh);

// Returns a function that reads chunks of `pmesh` and checks their SHA-256. Both arguments must
// outlive the function.
ChunkReader chunks_of(const Manifest& manifest, std::span<const std::uint8_t> pmesh);

// Returns the bytes of the i-th picture of the texture, after checking their SHA-256. Fails
// (kBadInput) if the file ends before the picture does, or if the bytes are damaged.
Expected<std::span<const std::uint8_t>> picture_of(const Manifest& manifest,
                                                   std::span<const std::uint8_t> pmesh,
                                                   std::size_t i);

// Returns the bytes of an optional block, after checking their SHA-256. Fails like picture_of().
Expected<std::span<const std::uint8_t>> optional_block(const OptionalBlock& block,
                                                       std::span<const std::uint8_t> pmesh);

}  // namespace vitrine::inline codec
