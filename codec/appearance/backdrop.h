// SPDX-License-Identifier: Apache-2.0
// The grey background over which pictures of models are compared.
#pragma once

#include <cstddef>

#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Blends a picture with grey. A colour byte c of a pixel with opacity o, from 0 to 1, becomes o * c
// + (1 - o) * 128, rounded. The opacities do not change.
void lay_over_grey(Picture& picture);

// Whether pixel number `index` shows a model in picture `a` or `b`: its opacity is above 0 in at
// least one of them. Both pictures must have the same size.
inline bool is_covered(const Picture& a, const Picture& b, std::size_t index) {
  return a.pixels[4 * index + 3] != 0 || b.pixels[4 * index + 3] != 0;
}

}  // namespace vitrine::inline codec
