// SPDX-License-Identifier: Apache-2.0
#include "codec/appearance/squared_error.h"

#include <cmath>

#include "codec/appearance/backdrop.h"

namespace vitrine::inline codec {

SquaredError squared_error(const Picture& a, const Picture& b) {
  SquaredError error;
  for (std::size_t pixel = 0; 4 * pixel < a.pixels.size(); ++pixel) {
    if (!is_covered(a, b, pixel)) continue;
    for (std::size_t c = 4 * pixel; c < 4 * pixel + 3; ++c) {
      const double difference = a.pixels[c] - b.pixels[c];
      error.sum += difference * difference;
    }
    error.bytes += 3;
  }
  return error;
}

std::optional<double> psnr(const SquaredError& error) {
  if (!(error.sum > 0)) return std::nullopt;
  return 10 * std::log10(255.0 * 255.0 * static_cast<double>(error.bytes) / error.sum);
}

}  // namespace vitrine::inline codec
