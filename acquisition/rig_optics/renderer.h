// SPDX-License-Identifier: Apache-2.0
// Renders the pictures that the simulated camera takes of the scene (stage.h).
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
  LaserLook look;         // if is_ideal is set, its speckle is ignored
};

inline constexpr SensorRegion kWholeSensor{0, 0, kSensorWidth, kSensorHeight};

struct Shot {
  // The scene's state. Its number of motions is ignored, because that number does not affect the
  // picture.
  Setting setting;
  Exposure exposure = {};
  SensorRegion region = kWholeSensor;
  // The laser's drift so far, in mm along the sheet's normal.
  double laser_shift = 0;
  bool has_second_stripe = false;  // whether the other laser is on as well
  bool is_laser_out = false;       // whether both lasers stay dark
};

// Returns the angle, in degrees, at which the motor really stops if its target is `degrees`. The
// error has a standard deviation of 0.05 degrees. It depends only on seed and angle.
double reached(const Realism& realism, double degrees);

// Renders the camera's pictures. Only one thread may use a renderer. Noise depends only on seed,
// target, laser and the angle within a revolution (in millionths of a degree). The same setting
// therefore always gives the same picture.
class Renderer {
 public:
  // `object` must outlive the renderer. If null, the scene is empty and reflects no light.
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
  // The scene for which light_ was computed. Both frames of a pair use the same scene.
  std::optional<LitScene> lit_;
  LightMap light_;
};

}  // namespace vitrine::acquisition::rig
