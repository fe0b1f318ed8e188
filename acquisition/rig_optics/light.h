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

// Grey level of the background in ambient light. The background is a wall and the black table.
inline constexpr float kBackground = 1.5F;

// Caches the viewing directions of the pixels, because computing them for every picture is slow.
class PixelRays {
 public:
  explicit PixelRays(const Lens& lens);

  // Returns the unit vector of a pixel's viewing direction, in the frame in which `lens` is given.
  // The lens may have moved since construction. `u` is the column, which may be fractional; `v` is
  // the row.
  Vec3 direction(const Lens& lens, double u, int v) const;

 private:
  // For each pixel, the slopes of its viewing direction: right and down components, each divided by
  // the forward component. Rows extend 8 pixels beyond both sides of the sensor, because the blur
  // reads these pixels.
  std::vector<float> slopes_;
};

// Returns the ambient light on the subject. Computes the light of every ambient_step()-th pixel
// (subject.h), and interpolates linearly between these pixels.
std::vector<float> ambient_light(const LocalOptics& optics, const PixelRays& rays,
                                 const Subject& subject);

// Returns the light of the laser's stripe. `look` gives the stripe's cross section and the contrast
// of its speckle, which is a function of `key` and the pixel. The surface reflects the light in
// part diffusely (Lambertian) and in part in a blurred specular lobe. Parts hidden from the camera
// or the laser are dark. The result includes the blur by the lens and the pixels.
std::vector<float> stripe_light(const LocalOptics& optics, const PixelRays& rays,
                                const Subject& subject, const LaserLook& look, std::uint64_t key);

}  // namespace vitrine::acquisition::rig
