// SPDX-License-Identifier: Apache-2.0
// Combines aligned scans into one surface.
#pragma once

#include <span>

#include "acquisition/alignment/scan_pair.h"

namespace vitrine::acquisition {

// Returns one mesh, in mm, in the frame of the first scan, without colours. `motions` holds the
// motion of each scan into that frame. Each part of the surface comes from the first scan that has
// it [TL94]: a face of a later scan is dropped if its corners and its centre are closer than
// `reach` mm to the earlier scans. Limits: overlapping measurements are not averaged, as [CL96]
// does. The seams stay open, and the surfaces overlap there by up to the width of a face.
TriangleMesh fused_surface(std::span<const PoseScan> scans, std::span<const RigidMotion> motions,
                           double reach);

}  // namespace vitrine::acquisition
