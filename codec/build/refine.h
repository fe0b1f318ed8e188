// SPDX-License-Identifier: Apache-2.0
// Refines a model to a detail target, with chunks from a function that the caller supplies.
#pragma once

#include <functional>

#include "codec/plan/planner.h"
#include "codec/refine/refiner.h"

namespace vitrine::inline codec {

// A function that checks the SHA-256 of chunk number `chunk` of the manifest and returns the bytes
// of the chunk.
using ChunkReader = std::function<Expected<std::span<const std::uint8_t>>(std::size_t chunk)>;

// Applies the chunks that the planner chooses for `want`, in the planner's order. If `want` is
// WantTriangles, then undoes the splits of the last chunk that exceed this number. Fails with the
// error of `read` or of Refiner::apply().
Expected<void> refine(Refiner& refiner, const Want& want, const ChunkReader& read);

}  // namespace vitrine::inline codec
