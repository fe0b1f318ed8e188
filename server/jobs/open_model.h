// SPDX-License-Identifier: Apache-2.0
// A .pmesh in memory, ready to be refined.
#pragma once

#include <cstdint>
#include <span>

#include "codec/progressive/refine.h"

namespace vitrine {

// Parses the header, checks the base mesh's SHA-256 and decodes it: a refiner at level 0. Chunks
// may be missing at the end of `pmesh`. Draco decodes the base: only inside the sandbox where the
// bytes come from outside.
Expected<Refiner> open_model(std::span<const std::uint8_t> pmesh);

// Reads chunks out of `pmesh` and checks their SHA-256. Both arguments must outlive the reader.
ChunkReader chunks_of(const Manifest& manifest, std::span<const std::uint8_t> pmesh);

}  // namespace vitrine
