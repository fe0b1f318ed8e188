// SPDX-License-Identifier: Apache-2.0
// The stripe's centre in one row, from the peak to the pixel.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "acquisition/profile/stripe.h"

namespace vitrine {

class SubPixel {
 public:
  explicit SubPixel(const StripeOptions& options);

  // In pixels. Nothing where the filter finds no peak near `u`, or the image ends too close by.
  // The difference of the rows is taken with its sign: cut off at zero it would draw the centre
  // towards the brighter background.
  std::optional<double> centre(std::span<const std::uint8_t> lit,
                               std::span<const std::uint8_t> dark, int u) const;

 private:
  std::optional<double> zero(std::span<const std::uint8_t> lit, std::span<const std::uint8_t> dark,
                             int u) const;
  std::optional<double> mass(std::span<const std::uint8_t> lit, std::span<const std::uint8_t> dark,
                             double u) const;

  StripeMethod method_;
  int reach_;                   // pixels on either side where the centre may be
  std::vector<double> kernel_;  // odd: of the distances 1, 2, …
};

}  // namespace vitrine
