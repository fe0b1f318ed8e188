// SPDX-License-Identifier: Apache-2.0
// Computes the size at which an error appears in a camera's image.
#pragma once

#include <array>
#include <limits>

#include "codec/core/lattice.h"
#include "codec/format/region_tree.h"

namespace vitrine::inline codec {

struct View {
  // Transform from camera to model coordinates, without scaling, in column-major order. The camera
  // looks along its negative z axis, and its y axis points up.
  std::array<double, 16> camera{};
  double field_of_view = 0;      // vertical angle in degrees, above 0 and below 180
  double width = 0, height = 0;  // size of the viewport in pixels, above 0
  double pixel_error = 1;        // largest acceptable error in pixels, above 0
  // Maximum number of bytes to fetch, including the header and the base mesh.
  double bytes = std::numeric_limits<double>::infinity();

  bool operator==(const View&) const = default;
};

// Whether all members are in range and finite. Only `bytes` may be infinite.
bool is_sane(const View& view);

// Returns the largest size, in pixels, at which an error can appear in the visible part of a box.
// Returns 0 if no part of the box is visible. `error` is a length in model units and counts as
// parallel to the screen. The box is first enlarged by the error. Depths below a thousandth of the
// box's diagonal are raised to this value.
double pixels_of(double error, const LatticeBox& box, const Lattice& lattice, const View& view);

}  // namespace vitrine::inline codec
