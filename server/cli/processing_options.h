// SPDX-License-Identifier: Apache-2.0
// The flags that say how a scan's pictures become a mesh.
#pragma once

#include "acquisition/session/processing.h"
#include "server/cli/arguments.h"

namespace vitrine::cli {

inline constexpr Flag kStripeFlag = {"--stripe", "METHOD",
                                     "derivative-of-gaussian (a new scan's), centre-of-mass or "
                                     "blais-rioux"};
inline constexpr Flag kSamplingFlag = {"--sampling", "adaptive|paper|equidistant",
                                       "of each profile (a new scan's: adaptive)"};
inline constexpr Flag kLengthFlag = {"--length", "5|10|15|20",
                                     "points that become one, about (a new scan's: 5)"};
inline constexpr Flag kLargestAngleFlag = {
    "--largest-angle", "DEGREES",
    "phi_max, up to which a step in depth of four spacings and more is joined, what is smaller "
    "always (a new scan's: 75)"};
inline constexpr Flag kLargestHoleFlag = {"--largest-hole", "MM",
                                          "that is filled; 0: none (a new scan's: 2)"};

// Of a command that declares all of them; what is not given is as in `otherwise`.
tl::expected<Processing, Fault> processing_options(const Arguments& arguments,
                                                   const Processing& otherwise);

}  // namespace vitrine::cli
