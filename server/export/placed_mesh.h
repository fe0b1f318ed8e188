// SPDX-License-Identifier: Apache-2.0
// Turns and scales a decoded mesh as its model is presented, before it is exported.
#pragma once

#include "codec/export/coarser_level.h"
#include "server/metadata/presentation.h"

namespace vitrine::server {

void place(TriangleMesh& mesh, const PresentationTransform& placement);
void place(CoarserLevel& level, const PresentationTransform& placement);

// Returns the grid to which a compressed file of the placed mesh rounds positions. The grid is
// moved and scaled, but not rotated. After an oblique rotation, rounding therefore moves vertices
// by up to half a step along each axis.
ExportGrid placed(const ExportGrid& grid, const PresentationTransform& placement);

}  // namespace vitrine::server
