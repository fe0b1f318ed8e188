// SPDX-License-Identifier: Apache-2.0
// Registers several scans together, so that the error is distributed over all pairs of scans.
#pragma once

#include <span>
#include <vector>

#include "acquisition/alignment/scan_pair.h"

namespace vitrine::acquisition {

// Repeatedly registers each scan except the first to all other scans at once ([CM92]). `motions`
// are the present motions into the frame of the first scan. Only points closer than `reach` mm are
// paired. Returns the new motions, or `motions` if the new ones do not lower the rms distance over
// all pairs.
std::vector<RigidMotion> register_jointly(std::span<const PreparedScan> scans,
                                          const std::vector<RigidMotion>& motions, double reach);

}  // namespace vitrine::acquisition
