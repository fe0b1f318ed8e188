// SPDX-License-Identifier: Apache-2.0
// Defines the command-line flags for the processing that makes a mesh from a scan's pictures.
#pragma once

#include "acquisition/session/processing.h"
#include "server/cli/support/arguments.h"

namespace vitrine::server::cli {

inline constexpr Flag kStripeFlag = {"--stripe", "METHOD",
                                     "how the laser stripe is located in a picture: "
                                     "derivative-of-gaussian, centre-of-mass or blais-rioux "
                                     "(default: derivative-of-gaussian; reprocess and --resume "
                                     "keep that of the scan)"};
inline constexpr Flag kSamplingFlag = {"--sampling", "METHOD",
                                       "points kept per stripe: adaptive (more at bends), "
                                       "equidistant or paper (the method of Wang, Li and Li); see "
                                       "acquisition/README.md (default: adaptive; reprocess and "
                                       "--resume keep that of the scan)"};
inline constexpr Flag kLengthFlag = {"--length", "5|10|15|20",
                                     "number of measured points that --sampling reduces to one, on "
                                     "average (default: 5; reprocess and --resume keep that of the "
                                     "scan)"};
inline constexpr Flag kLargestAngleFlag = {
    "--largest-angle", "DEGREES",
    "largest angle between view and surface normal, 0 to 90, at which points far apart in depth "
    "are still joined (default: 75; reprocess and --resume keep that of the scan)"};
inline constexpr Flag kLargestHoleFlag = {
    "--largest-hole", "MM",
    "largest width of a hole that is closed; 0: none (default: 2; reprocess and --resume keep that "
    "of the scan)"};

// Reads the processing flags, all of which the command must declare. Options without a flag on the
// command line keep the values of `otherwise`.
tl::expected<acquisition::Processing, Fault> processing_options(
    const Arguments& arguments, const acquisition::Processing& otherwise);

}  // namespace vitrine::server::cli
