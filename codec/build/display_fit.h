// SPDX-License-Identifier: Apache-2.0
// Chooses the strength of a level's display filter.
#pragma once

#include "codec/coding/mesh_state.h"
#include "codec/core/lattice.h"
#include "codec/mesh/triangle_bvh.h"

namespace vitrine::inline codec {

// Returns the filter strength in [0, 1] that brings the displayed level closest to `original`
// (model units). Uses least squares over the centroids of up to 1,000 faces.
double fit_display_filter(const MeshState& level, const Lattice& lattice,
                          const TriangleBvh& original);

}  // namespace vitrine::inline codec
