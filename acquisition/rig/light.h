// SPDX-License-Identifier: Apache-2.0
// The light that reaches each pixel, before a camera makes numbers of it.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/rig/subject.h"
#include "acquisition/rig/view.h"

namespace vitrine::rig {

enum class StripeShape { kGaussian, kTopHat, kSkewed };

struct LaserLook {
  StripeShape shape = StripeShape::kGaussian;
  double speckle = 0.33;  // its contrast, standard deviation over mean; 0: none
};

// Per pixel of the sensor, row after row; in grey levels at the exposure and gain of kExposureUs.
struct LightMap {
  std::vector<float> ambient, laser;
};

// In ambient light: the wall behind, and the table, painted black.
inline constexpr float kBackground = 1.5F;

// The directions in which the pixels look, which take too long to find for every picture.
class PixelRays {
 public:
  explicit PixelRays(const Lens& lens);

  // `u` may be between pixels; unit vector in the frame that the lens has now, which may be another
  // than it had.
  Vec3 direction(const Lens& lens, double u, int v) const;

 private:
  std::vector<float> slopes_;  // right and down over forward, a pair a pixel, one column to spare
};

// What ambient light shows, at every ambient_step()-th pixel and between these linearly.
std::vector<float> ambient_light(const View& view, const PixelRays& rays, const Subject& subject);

// The stripe: Lambert and a blurred mirror under a sheet of light of that profile, hidden parts
// dark, blurred by lens and pixels, then speckled as a function of `key` and the pixel.
std::vector<float> stripe_light(const View& view, const PixelRays& rays, const Subject& subject,
                                const LaserLook& look, std::uint64_t key);

}  // namespace vitrine::rig
