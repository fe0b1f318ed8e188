// SPDX-License-Identifier: Apache-2.0
// Refines the stripe's centre in one row from pixel to sub-pixel precision.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "acquisition/profile/stripe.h"

namespace vitrine::acquisition {

class SubPixel {
 public:
  explicit SubPixel(const StripeOptions& options);

  // Returns the stripe's centre in pixels, near pixel `u`. Returns nullopt if there is no peak near
  // `u`, or if the image's border is too close. Uses the difference `lit` - `dark` of each pixel.
  // Negative differences are not clipped to 0, because that would shift the centre towards the side
  // with the brighter background.
  std::optional<double> centre(std::span<const std::uint8_t> lit,
                               std::span<const std::uint8_t> dark, int u) const;

 private:
  std::optional<double> zero(std::span<const std::uint8_t> lit, std::span<const std::uint8_t> dark,
                             int u) const;
  std::optional<double> mass(std::span<const std::uint8_t> lit, std::span<const std::uint8_t> dark,
                             double u) const;

  StripeMethod method_;
  int reach_;                   // largest distance, in pixels, between the centre and the peak
  std::vector<double> kernel_;  // values of an odd function at the distances 1, 2, … pixels
};

}  // namespace vitrine::acquisition
