// SPDX-License-Identifier: Apache-2.0
#include "codec/export/screen_coverage.h"

#include <algorithm>
#include <numbers>

namespace vitrine::inline codec {

std::vector<double> screen_coverages(const Bounds& box, std::span<const CoarserLevel> coarser) {
  constexpr double kScreenPixels = 1920.0 * 1080.0;
  const double diameter = length(box.high - box.low);
  std::vector<double> shares;
  double share = 1;
  for (const CoarserLevel& level : coarser) {
    // Diameter in pixels of the bounding sphere when the error is one pixel.
    const double pixels = level.error > 0 ? diameter / level.error : kScreenPixels;
    share = std::min(share, std::numbers::pi / 4 * pixels * pixels / kScreenPixels);
    shares.push_back(share);
  }
  shares.push_back(0);
  return shares;
}

}  // namespace vitrine::inline codec
