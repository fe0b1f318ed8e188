// SPDX-License-Identifier: Apache-2.0
// The structural similarity index (SSIM) of two pictures [WBSS04].
#pragma once

#include <optional>

#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Returns the mean SSIM index of the luma of two pictures ([WBSS04] eq. 13). The luma is 0.299 R +
// 0.587 G + 0.114 B of the sRGB bytes, not rounded. A window has 11 x 11 pixels, with Gaussian
// weights of standard deviation 1.5 pixels (eq. 14-16). K1 = 0.01, K2 = 0.03 and L = 255.
//
// The mean is over the windows that lie inside the picture and whose centre pixel shows a model in
// at least one picture (is_covered() in backdrop.h). Eq. 17 averages over all windows instead.
// Returns nullopt if no window qualifies. Both pictures must have the same size.
std::optional<double> structural_similarity(const Picture& a, const Picture& b);

}  // namespace vitrine::inline codec
