// SPDX-License-Identifier: Apache-2.0
// The light of all pictures: one lamp at the upper left behind the viewer, and ambient light from
// sky and floor. The light is the same as in the initial view of the viewer page.
#pragma once

#include "codec/render/framing.h"

namespace vitrine::inline codec {

// Converts an sRGB-coded colour to linear light.
Vec3 linear_light(const Colour& srgb);

class Light {
 public:
  // The lamp moves with the eye. The sky stays above the model.
  explicit Light(const ViewAxes& axes);

  // Returns the light that a surface with the unit normal `n` receives. `n` is in view space; 1 is
  // white.
  Vec3 on(const Vec3& n) const;

 private:
  Vec3 lamp_, lamp_colour_, sky_, floor_, up_;
};

}  // namespace vitrine::inline codec
