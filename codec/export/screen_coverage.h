// SPDX-License-Identifier: Apache-2.0
// The sizes on the screen at which a coarser level of detail replaces a finer one
// (MSFT_screencoverage of [glTF]).
#pragma once

#include <span>
#include <vector>

#include "codec/core/bounds.h"
#include "codec/export/coarser_level.h"

namespace vitrine::inline codec {

// Returns, for each level from the finest on, the smallest share of the screen's area that the
// model covers while the level is shown. At a smaller share, the error of the next level is below
// one pixel of a screen with 1920 x 1080 pixels. The last share is 0. `box` is the bounding box of
// the model, `coarser` are the levels below the finest one, from fine to coarse.
std::vector<double> screen_coverages(const Bounds& box, std::span<const CoarserLevel> coarser);

}  // namespace vitrine::inline codec
