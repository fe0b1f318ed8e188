// SPDX-License-Identifier: Apache-2.0
// Refines a model to a detail target. The caller supplies a function that reads chunks.
#pragma once

#include <cstdint>
#include <functional>

#include "codec/core/vec.h"
#include "codec/plan/planner.h"
#include "codec/refine/refiner.h"

namespace vitrine::inline codec {

// Returns the bytes of the manifest's chunk number `chunk`, after checking their SHA-256.
using ChunkReader = std::function<Expected<std::span<const std::uint8_t>>(std::size_t chunk)>;

// Applies the chunks that the planner chooses for the detail target `want`, in the planner's order.
// If `want` is a WantTriangles, then undoes the last splits that exceed the requested number of
// triangles. Fails with the error of `read` or of Refiner::apply().
Expected<void> refine(Refiner& refiner, const Want& want, const ChunkReader& read);

// The detail that a refiner shows.
struct ShownDetail {
  std::uint32_t level = 0;  // the finest complete level
  double error = 0;         // upper bound of the error of that level, in model units
  // The lattice on which the vertices lie if the display filter is off, in model units: the points
  // grid_origin + grid_step * integer. These are the centres of the cells of the finest level that
  // is shown at least in part.
  Vec3 grid_origin;
  double grid_step = 1;
};
ShownDetail shown_detail(const Refiner& refiner);

}  // namespace vitrine::inline codec
