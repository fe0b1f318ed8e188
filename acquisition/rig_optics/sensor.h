// SPDX-License-Identifier: Apache-2.0
// Digitises light: exposure, gain, noise and saturation.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/frame/frame.h"
#include "acquisition/rig_optics/light.h"

namespace vitrine::acquisition::rig {

inline constexpr double kExposureUs = 5000;  // exposure at which LightMap values are grey levels

struct Exposure {
  double us = kExposureUs, gain_db = 0;
};

// Exposes one frame. Black is at grey level 8, so that noise is not clipped. Read noise has a
// standard deviation of 2.2 grey levels at any gain. Shot noise assumes 20 electrons per grey
// level. `noise` is the key of this picture's noise; 0 disables noise.
Frame expose(const LightMap& light, bool laser, const Exposure& exposure, std::uint64_t noise,
             const SensorRegion& region);

}  // namespace vitrine::acquisition::rig
