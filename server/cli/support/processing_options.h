// SPDX-License-Identifier: Apache-2.0
// Defines the command-line flags for the processing that makes a mesh from a scan's pictures.
#pragma once

#include "acquisition/session/processing.h"
#include "server/cli/support/arguments.h"

namespace vitrine::server::cli {

// The help texts name no defaults, because they differ: `scan` adds its own, `reprocess` keeps the
// values of the scan.
inline constexpr Flag kStripeFlag = {
    "--stripe", "METHOD",
    "how the laser stripe is located in a picture: derivative-of-gaussian, centre-of-mass or "
    "blais-rioux"};
inline constexpr Flag kSamplingFlag = {
    "--sampling", "METHOD",
    "which points of a stripe are kept: adaptive (more at bends), equidistant or paper (the "
    "method of Wang, Li and Li)"};
inline constexpr Flag kLengthFlag = {"--length", "5|10|15|20",
                                     "number of measured points for each kept point, on average"};
inline constexpr Flag kLargestAngleFlag = {
    "--largest-angle", "DEGREES",
    "largest angle between view and surface normal, 0 to 90, at which neighbouring points are "
    "still joined although their depths differ much"};
inline constexpr Flag kLargestHoleFlag = {"--largest-hole", "MM",
                                          "largest width of a hole that is closed; 0: none"};

// Reads the processing flags, all of which the command must declare. Options without a flag on the
// command line keep the values of `otherwise`.
tl::expected<acquisition::Processing, Fault> processing_options(
    const Arguments& arguments, const acquisition::Processing& otherwise);

}  // namespace vitrine::server::cli
