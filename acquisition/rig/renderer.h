// SPDX-License-Identifier: Apache-2.0
// Pictures of what stands on the stage.
#pragma once

#include <cstdint>
#include <optional>

#include "acquisition/frame/frame.h"
#include "acquisition/rig/light.h"
#include "acquisition/rig/optics.h"
#include "acquisition/rig/sensor.h"
#include "acquisition/rig/stage.h"
#include "acquisition/rig/target.h"

namespace vitrine::rig {

struct Realism {
  std::uint64_t seed = 1;
  bool ideal = false;  // no noise, no speckle, a motor without error
  LaserLook look;      // its speckle is not used where `ideal`
};

inline constexpr SensorRegion kWholeSensor{0, 0, kSensorWidth, kSensorHeight};

struct Shot {
  Setting setting;  // its turns do not count: only what can be seen does
  Exposure exposure = {};
  SensorRegion region = kWholeSensor;
  double laser_shift = 0;      // mm along the sheet's normal: how far it has crept
  bool second_stripe = false;  // the other laser lights with it
  bool laser_out = false;      // neither lights
};

// Where the motor really stops when it is told to go to `degrees`: 0.05 degrees of error, standard
// deviation, a function of the seed and the angle.
double reached(const Realism& realism, double degrees);

// For one thread. All noise is a function of seed, angle (in millionths of a degree, within a
// turn), target and laser alone: the same setting gives the same picture.
class Renderer {
 public:
  // `object` may be null: nothing that shows light. It is not owned.
  Renderer(const Optics& optics, const Subject* object, const Realism& realism);

  Frame take(const Shot& shot);

 private:
  struct Scene {
    std::uint64_t key = 0;
    double laser_shift = 0;
    bool second_stripe = false;
    bool operator==(const Scene&) const = default;
  };
  std::uint64_t scene_key(const Setting& setting) const;
  void light_up(const Shot& shot, const Scene& scene);

  Optics optics_;
  const Subject* object_;
  Realism realism_;
  PixelRays rays_;
  std::optional<Target> target_;  // printed when first asked for
  std::vector<TargetPose> poses_;
  std::optional<Scene> lit_;  // what light_ is of: both frames of a pair share it
  LightMap light_;
};

}  // namespace vitrine::rig
