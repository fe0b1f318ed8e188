// SPDX-License-Identifier: Apache-2.0
// Refines a model to a detail target, with chunks in memory.
#pragma once

#include <functional>

#include "codec/plan/planner.h"
#include "codec/refine/refiner.h"

namespace vitrine::inline codec {

// Returns the bytes of chunk number `chunk` of the manifest after it has checked their SHA-256.
using ChunkReader = std::function<Expected<std::span<const std::uint8_t>>(std::size_t chunk)>;

// Applies the chunks that the planner chooses for `want`, in the planner's order. Fails with the
// error of `read` or of Refiner::apply().
Expected<void> refine(Refiner& refiner, const Want& want, const ChunkReader& read);

}  // namespace vitrine::inline codec
