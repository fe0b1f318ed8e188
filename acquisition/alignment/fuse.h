// SPDX-License-Identifier: Apache-2.0
// Makes one surface of aligned scans.
#pragma once

#include <span>

#include "acquisition/alignment/scan_pair.h"

namespace vitrine::acquisition {

// Returns one mesh, in mm, in the frame of the first scan, without colours. `motions` has the
// motion of each scan into that frame. Each part of the surface comes from the first scan that saw
// it
// ([TL94]): a face of a later scan is dropped if its corners and centre lie closer than `reach` mm
// to the earlier scans. Limits: overlapping measurements are not averaged. The seam stays open, and
// surfaces overlap there by up to a face's width.
TriangleMesh fused_surface(std::span<const PoseScan> scans, std::span<const RigidMotion> motions,
                           double reach);

}  // namespace vitrine::acquisition
