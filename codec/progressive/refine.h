// SPDX-License-Identifier: Apache-2.0
// Brings a refiner to what is wanted, from chunks that are at hand.
#pragma once

#include <functional>

#include "codec/progressive/planner.h"
#include "codec/progressive/refiner.h"

namespace vitrine {

// Returns the bytes of manifest().chunks[chunk], already checked against its SHA-256.
using ChunkReader = std::function<Expected<std::span<const std::uint8_t>>(std::size_t chunk)>;

Expected<void> refine(Refiner& refiner, const Want& want, const ChunkReader& read);

}  // namespace vitrine
