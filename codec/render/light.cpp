// SPDX-License-Identifier: Apache-2.0
#include "codec/render/light.h"

#include <algorithm>

#include "codec/core/linear_colour.h"
#include "codec/render/unit_vector.h"

namespace vitrine::inline codec {

Vec3 linear_light(const Colour& srgb) {
  const LinearColour c = to_linear(srgb);
  return {c[0], c[1], c[2]};
}

Light::Light(const ViewAxes& axes)
    : lamp_(unit_vector({-0.6, 0.9, 1.0})),
      lamp_colour_(linear_light({0xff, 0xfa, 0xf2}) * 0.72),
      sky_(Vec3{1, 1, 1} * 0.34),
      floor_(linear_light({0x8a, 0x81, 0x78}) * 0.34),
      up_(axes.to_view({0, 1, 0})) {}

Vec3 Light::on(const Vec3& n) const {
  const double high = 0.5 + 0.5 * dot(n, up_);
  return lamp_colour_ * std::max(0.0, dot(n, lamp_)) + sky_ * high + floor_ * (1 - high);
}

}  // namespace vitrine::inline codec
