// SPDX-License-Identifier: Apache-2.0
// Light to numbers: exposure, gain, noise, and the end of the range.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/frame/frame.h"
#include "acquisition/rig/light.h"

namespace vitrine::rig {

inline constexpr double kExposureUs = 5000;  // at which a LightMap is in grey levels

struct Exposure {
  double us = kExposureUs, gain_db = 0;
};

// Fixed: black stands at 8 grey levels, so that noise shows to both sides; a pixel has read noise
// of 2.2 grey levels at any gain, and shot noise as of 20 electrons a level.
// `noise` is the key of this picture; 0: no noise.
Frame expose(const LightMap& light, bool laser, const Exposure& exposure, std::uint64_t noise,
             const SensorRegion& region);

}  // namespace vitrine::rig
