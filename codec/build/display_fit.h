// SPDX-License-Identifier: Apache-2.0
// Chooses the strength of a level's display filter (display_filter.h), which moves displayed
// vertices closer to the original surface.
#pragma once

#include "codec/coding/mesh_state.h"
#include "codec/core/lattice.h"
#include "codec/distance/witness_surface.h"

namespace vitrine::inline codec {

// Returns the filter strength in [0, 1] that brings the displayed level closest to `original`
// (model units). Uses least squares over the centroids of up to 1,000 faces.
double fit_display_filter(const MeshState& level, const Lattice& lattice,
                          const WitnessSurface& original);

}  // namespace vitrine::inline codec
