// SPDX-License-Identifier: Apache-2.0
// Digitises light: exposure, gain, noise and saturation.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/frame/frame.h"
#include "acquisition/rig_optics/light.h"

namespace vitrine::acquisition::rig {

inline constexpr double kExposureUs = 5000;  // exposure time at which a LightMap is in grey levels

struct Exposure {
  double us = kExposureUs, gain_db = 0;
};

// Exposes one frame. Black is 8 grey levels, so that noise is not clipped. Read noise is 2.2 grey
// levels at any gain, and shot noise is that of 20 electrons for each level. `noise` is the key of
// this picture's noise; 0 disables noise.
Frame expose(const LightMap& light, bool laser, const Exposure& exposure, std::uint64_t noise,
             const SensorRegion& region);

}  // namespace vitrine::acquisition::rig
