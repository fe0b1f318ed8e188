// SPDX-License-Identifier: Apache-2.0
// How large an error looks to a camera.
#pragma once

#include <array>
#include <limits>

#include "codec/core/lattice.h"
#include "codec/progressive/region_tree.h"

namespace vitrine {

struct View {
  // From the camera's coordinates to the model's, column by column; no scale. The camera looks
  // along its -z axis, its y axis is up.
  std::array<double, 16> camera{};
  double field_of_view = 0;      // from bottom to top, degrees, above 0 and below 180
  double width = 0, height = 0;  // of the viewport, pixels, above 0
  double pixel_error = 1;        // errors up to this need no refinement, pixels, above 0
  // Bytes held at most, head included.
  double bytes = std::numeric_limits<double>::infinity();

  bool operator==(const View&) const = default;
};

// All members are finite (but for `bytes`) and in their ranges.
bool is_sane(const View& view);

// Pixels that an error (model units, parallel to the screen) has at most in the part of the box,
// enlarged by the error, that is in sight; 0 where none is. A depth of a thousandth of the box'
// diagonal counts at least.
double pixels_of(double error, const LatticeBox& box, const Lattice& lattice, const View& view);

}  // namespace vitrine
