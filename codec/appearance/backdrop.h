// SPDX-License-Identifier: Apache-2.0
// The grey background over which pictures of models are compared.
#pragma once

#include <cstddef>

#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Lays a picture over grey: each colour byte c of a pixel with the opacity o, 0 to 1, becomes
// o * c + (1 - o) * 128, rounded. Keeps the opacities.
void lay_over_grey(Picture& picture);

// Whether either of two pictures of the same size shows a model at the pixel `index`: its opacity
// is above 0.
inline bool is_covered(const Picture& a, const Picture& b, std::size_t index) {
  return a.pixels[4 * index + 3] != 0 || b.pixels[4 * index + 3] != 0;
}

}  // namespace vitrine::inline codec
