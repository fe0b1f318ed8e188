// SPDX-License-Identifier: Apache-2.0
// Distributes the error of registration over all pairs of scans.
#pragma once

#include <span>
#include <vector>

#include "acquisition/alignment/scan_pair.h"

namespace vitrine::acquisition {

// Registers each scan but the first to all others at once ([CM92]), again and again. `motions` are
// the present motions into the frame of the first scan; `reach` in mm. Returns the new motions, or
// `motions` if they do not lower the rms distance over all pairs.
std::vector<RigidMotion> register_jointly(std::span<const PreparedScan> scans,
                                          const std::vector<RigidMotion>& motions, double reach);

}  // namespace vitrine::acquisition
