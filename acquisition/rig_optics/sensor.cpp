// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/sensor.h"

#include <algorithm>
#include <cmath>

#include "acquisition/rig_optics/noise.h"

namespace vitrine::acquisition::rig {
namespace {

// Grey level of black, read noise in grey levels, and number of electrons per grey level.
constexpr float kBlack = 8, kReadNoise = 2.2F, kElectrons = 20;

std::uint8_t grey(float level) {
  return static_cast<std::uint8_t>(std::clamp(level + 0.5F, 0.0F, 255.0F));
}

// Converts light to a grey level. Called for each pixel of each frame, so it must be fast.
struct Amplifier {
  float gain, shot;

  template <bool kLaser, bool kNoise>
  void row(const float* ambient, const float* laser, int width, NormalSequence noise,
           std::uint8_t* out) const {
    for (int u = 0; u < width; ++u) {
      const float signal = gain * (kLaser ? ambient[u] + laser[u] : ambient[u]);
      float level = kBlack + signal;
      if (kNoise) level += std::sqrt(kReadNoise * kReadNoise + shot * signal) * noise.next();
      out[u] = grey(level);
    }
  }
};

}  // namespace

Frame expose(const LightMap& light, bool laser, const Exposure& exposure, std::uint64_t noise,
             const SensorRegion& region) {
  const double amplified = std::pow(10, exposure.gain_db / 20);
  const Amplifier amplifier{static_cast<float>(amplified * exposure.us / kExposureUs),
                            static_cast<float>(amplified / kElectrons)};
  const auto row =
      laser ? (noise != 0 ? &Amplifier::row<true, true> : &Amplifier::row<true, false>)
            : (noise != 0 ? &Amplifier::row<false, true> : &Amplifier::row<false, false>);
  Frame frame{region.width, region.height, {}};
  frame.pixels.resize(static_cast<std::size_t>(region.width) * region.height);
  for (int v = 0; v < region.height; ++v) {
    const auto first = static_cast<std::size_t>(v + region.y) * kSensorWidth + region.x;
    (amplifier.*row)(light.ambient.data() + first, light.laser.data() + first, region.width,
                     NormalSequence(noise, first),
                     frame.pixels.data() + static_cast<std::ptrdiff_t>(v) * region.width);
  }
  return frame;
}

}  // namespace vitrine::acquisition::rig
