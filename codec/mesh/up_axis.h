// SPDX-License-Identifier: Apache-2.0
// The axis of a mesh that points up, and the quarter turns about the x axis between y up and z up.
// The turns are exact and mirror nothing.
#pragma once

#include <string_view>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

enum class UpAxis { kY, kZ };

constexpr Vec3 turn_z_up_to_y(const Vec3& p) {
  return {p.x, p.z, -p.y};
}
// Subtracts from 0 instead of negating, because -0.0 would appear as "-0" in text formats.
constexpr Vec3 turn_y_up_to_z(const Vec3& p) {
  return {p.x, 0 - p.z, p.y};
}

constexpr std::string_view name_of(UpAxis up) {
  return up == UpAxis::kZ ? "z" : "y";
}

}  // namespace vitrine::inline codec
