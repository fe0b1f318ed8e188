// SPDX-License-Identifier: Apache-2.0
// Renders pictures of the stage.
#pragma once

#include <cstdint>
#include <optional>

#include "acquisition/frame/frame.h"
#include "acquisition/rig_optics/light.h"
#include "acquisition/rig_optics/optics.h"
#include "acquisition/rig_optics/sensor.h"
#include "acquisition/rig_optics/stage.h"
#include "acquisition/rig_optics/target.h"

namespace vitrine::acquisition::rig {

struct Realism {
  std::uint64_t seed = 1;
  bool is_ideal = false;  // disables noise, speckle and the motor's error
  LaserLook look;         // its speckle is ignored if is_ideal is set
};

inline constexpr SensorRegion kWholeSensor{0, 0, kSensorWidth, kSensorHeight};

struct Shot {
  // The number of motions in it is ignored, because it does not affect the picture.
  Setting setting;
  Exposure exposure = {};
  SensorRegion region = kWholeSensor;
  // The laser's drift so far, in mm along the sheet's normal.
  double laser_shift = 0;
  bool has_second_stripe = false;  // whether the other laser is on as well
  bool is_laser_out = false;       // whether both lasers stay dark
};

// Returns the angle at which the motor really stops if its target is `degrees`. The error has a
// standard deviation of 0.05 degrees and is a function of seed and angle.
double reached(const Realism& realism, double degrees);

// Renders the camera's pictures. Only one thread may use it. All noise is a function of seed, angle
// within a revolution (in millionths of a degree), target and laser. So the same setting always
// gives the same picture.
class Renderer {
 public:
  // `object` must outlive the renderer. Null means that nothing reflects light.
  Renderer(const Optics& optics, const Subject* object, const Realism& realism);

  Frame take(const Shot& shot);

 private:
  struct LitScene {
    std::uint64_t key = 0;
    double laser_shift = 0;
    bool has_second_stripe = false;
    bool operator==(const LitScene&) const = default;
  };
  std::uint64_t scene_key(const Setting& setting) const;
  void light_up(const Shot& shot, const LitScene& scene);

  Optics optics_;
  const Subject* object_;
  Realism realism_;
  PixelRays rays_;
  std::optional<PrintedTarget> target_;  // created on first use
  std::vector<TargetPose> poses_;
  // The scene that light_ shows. Both frames of a pair share it.
  std::optional<LitScene> lit_;
  LightMap light_;
};

}  // namespace vitrine::acquisition::rig
