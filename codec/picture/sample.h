// SPDX-License-Identifier: Apache-2.0
// Samples the colours of a picture, interpolating between pixels.
#pragma once

#include "codec/core/linear_colour.h"
#include "codec/mesh/texturing.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Returns the colour at (u, v), where v = 0 is the top edge. Interpolates bilinearly between pixel
// centres, in linear light. Coordinates that are not finite are treated as 0. `picture` must have
// at least one pixel.
LinearColour sample(const Picture& picture, double u, double v, Wrap wrap_u, Wrap wrap_v);

}  // namespace vitrine::inline codec
