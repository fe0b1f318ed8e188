// SPDX-License-Identifier: Apache-2.0
// The structural similarity index (SSIM) of two pictures [WBSS04].
#pragma once

#include <optional>

#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Returns the mean SSIM index ([WBSS04] eq. 13) of the luma 0.299 R + 0.587 G + 0.114 B of
// sRGB-coded bytes, not rounded. The weights of a window are a Gaussian with a standard deviation
// of 1.5 pixels on 11 x 11 pixels (eq. 14-16); K1 = 0.01, K2 = 0.03 and L = 255.
//
// The mean is over the windows that lie in the picture and whose centre either picture covers
// (backdrop.h), unlike eq. 17, which takes all windows. Returns nullopt if there is no such window.
// Both pictures must have the same size.
std::optional<double> structural_similarity(const Picture& a, const Picture& b);

}  // namespace vitrine::inline codec
