// SPDX-License-Identifier: Apache-2.0
// The squared error between pictures, and its peak signal-to-noise ratio.
#pragma once

#include <cstdint>
#include <optional>

#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Sum over the red, green and blue bytes of the compared pixels.
struct SquaredError {
  double sum = 0;
  std::uint64_t bytes = 0;

  void operator+=(const SquaredError& other) { sum += other.sum, bytes += other.bytes; }
};

// Compares the pixels that either picture covers (backdrop.h). Both must have the same size.
SquaredError squared_error(const Picture& a, const Picture& b);

// Returns 10 * log10(255^2 / mean squared error), in decibels. Returns nullopt if the error is 0 or
// no byte was compared.
std::optional<double> psnr(const SquaredError& error);

}  // namespace vitrine::inline codec
