// SPDX-License-Identifier: Apache-2.0
// Computes the light that reaches each pixel, before the sensor digitises it.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/rig_optics/local_optics.h"
#include "acquisition/rig_optics/subject.h"

namespace vitrine::acquisition::rig {

enum class StripeShape { kGaussian, kTopHat, kSkewed };

struct LaserLook {
  StripeShape shape = StripeShape::kGaussian;
  // Contrast of the speckle: standard deviation over mean. 0 disables speckle.
  double speckle = 0.33;
};

// Light on the sensor: one value for each pixel, row by row, in grey levels at exposure
// kExposureUs.
struct LightMap {
  std::vector<float> ambient, laser;
};

// Grey level, in ambient light, of the background: a wall and the table, which is painted black.
inline constexpr float kBackground = 1.5F;

// The viewing directions of the pixels. They are cached because computing them for every picture is
// slow.
class PixelRays {
 public:
  explicit PixelRays(const Lens& lens);

  // Returns the unit direction in which a pixel looks, in the frame of `lens`, which may have moved
  // since construction. `u` may be fractional.
  Vec3 direction(const Lens& lens, double u, int v) const;

 private:
  // For each pixel, the components of its direction to the right and down, each divided by the
  // forward component. Rows have one spare column.
  std::vector<float> slopes_;
};

// Returns the ambient light on the subject. It is computed for every ambient_step()-th pixel and
// linearly interpolated between.
std::vector<float> ambient_light(const LocalOptics& optics, const PixelRays& rays,
                                 const Subject& subject);

// Returns the light of the stripe, cast by a sheet of light with the profile `look`. The surface
// reflects it by Lambertian and blurred specular reflection. Parts hidden from camera or laser are
// dark. Lens and pixels blur the light; speckle, a function of `key` and the pixel, modulates it.
std::vector<float> stripe_light(const LocalOptics& optics, const PixelRays& rays,
                                const Subject& subject, const LaserLook& look, std::uint64_t key);

}  // namespace vitrine::acquisition::rig
