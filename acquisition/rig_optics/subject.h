// SPDX-License-Identifier: Apache-2.0
// The object or calibration target in front of the simulated camera. Coordinates are in mm, in the
// subject's own frame.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "codec/core/vec.h"

namespace vitrine::acquisition::rig {

struct RayHit {
  Vec3 at, normal;    // position in mm; unit normal, which may point to either side
  double albedo = 0;  // share of light reflected, 0 to 1
  double gloss = 0;   // share of light reflected as a blurred highlight
};

class Subject {
 public:
  using ConvexPolygon = std::span<const Vec3>;  // corners of a planar convex polygon

  virtual ~Subject() = default;

  // Returns the first point that a ray hits, or nullopt if there is none. `direction` is a unit
  // vector.
  virtual std::optional<RayHit> first_hit(const Vec3& from, const Vec3& direction) const = 0;
  // Returns whether the subject casts a shadow on its own `point`, lit from `source`.
  virtual bool shadowed(const RayHit& point, const Vec3& source) const = 0;
  // Visits all polygons that come within `half` mm of the plane dot(normal, p) == offset, and
  // possibly others.
  virtual void near_plane(const Vec3& normal, double offset, double half,
                          const std::function<void(ConvexPolygon)>& visit) const = 0;

  // ambient_step() is the distance in pixels between samples of the ambient light. ambient_light()
  // is the brightness of a white surface that faces the camera, in grey levels at exposure
  // kExposureUs.
  virtual int ambient_step() const = 0;
  virtual double ambient_light() const = 0;
};

}  // namespace vitrine::acquisition::rig
