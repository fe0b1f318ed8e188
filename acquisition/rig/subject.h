// SPDX-License-Identifier: Apache-2.0
// Something to take pictures of, in a frame of its own, in mm.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "codec/core/vec.h"

namespace vitrine::rig {

struct SurfacePoint {
  Vec3 at, normal;    // unit, to either side
  double albedo = 0;  // 0 to 1
  double gloss = 0;   // share of light that is mirrored, blurred
};

class Subject {
 public:
  using Corners = std::span<const Vec3>;  // of a plane convex polygon

  virtual ~Subject() = default;

  // The first point that a ray meets; `direction` is a unit vector.
  virtual std::optional<SurfacePoint> first_hit(const Vec3& from, const Vec3& direction) const = 0;
  // Whether the subject itself keeps the light of `source` from `point` of it.
  virtual bool shadowed(const SurfacePoint& point, const Vec3& source) const = 0;
  // Visits at least every part with |dot(normal, p) - offset| <= half.
  virtual void near_plane(const Vec3& normal, double offset, double half,
                          const std::function<void(Corners)>& visit) const = 0;

  // Pixels between the samples of what ambient light shows, and its strength.
  virtual int ambient_step() const = 0;
  virtual double ambient_light() const = 0;
};

}  // namespace vitrine::rig
