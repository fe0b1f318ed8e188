// SPDX-License-Identifier: Apache-2.0
// The squared error between two pictures, and the peak signal-to-noise ratio computed from it.
#pragma once

#include <cstdint>
#include <optional>

#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Sum of the squared differences of the red, green and blue bytes, and the number of these bytes.
struct SquaredError {
  double sum = 0;
  std::uint64_t bytes = 0;

  void operator+=(const SquaredError& other) { sum += other.sum, bytes += other.bytes; }
};

// Compares the pixels that show a model in at least one of the pictures (is_covered() in
// backdrop.h). Both pictures must have the same size.
SquaredError squared_error(const Picture& a, const Picture& b);

// Returns 10 * log10(255^2 / mean squared error), in decibels. Returns nullopt if the error is 0 or
// no byte was compared.
std::optional<double> psnr(const SquaredError& error);

}  // namespace vitrine::inline codec
