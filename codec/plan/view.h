// SPDX-License-Identifier: Apache-2.0
// Computes how large an error appears in a camera's image.
#pragma once

#include <array>
#include <limits>

#include "codec/core/lattice.h"
#include "codec/format/region_tree.h"

namespace vitrine::inline codec {

struct View {
  // Transform from camera to model coordinates, stored column by column, without scale. The camera
  // looks along its negative z axis, and its y axis points up.
  std::array<double, 16> camera{};
  double field_of_view = 0;      // vertical angle in degrees, above 0 and below 180
  double width = 0, height = 0;  // size of the viewport in pixels, above 0
  double pixel_error = 1;        // errors of up to this many pixels need no refinement; above 0
  // Maximum number of bytes to hold, including the header and the base mesh.
  double bytes = std::numeric_limits<double>::infinity();

  bool operator==(const View&) const = default;
};

// Whether all members are in their ranges and finite. Only `bytes` may be infinite.
bool is_sane(const View& view);

// Returns the largest size in pixels at which an error can appear in the visible part of a box, or
// 0 if no part is visible. The error is a length in model units, parallel to the screen. The box is
// first enlarged by the error. Depths below a thousandth of the box's diagonal are raised to that
// value.
double pixels_of(double error, const LatticeBox& box, const Lattice& lattice, const View& view);

}  // namespace vitrine::inline codec
