// SPDX-License-Identifier: Apache-2.0
// The pictures that a calibration is made from: the target in many places, each without and with
// the laser's line on it.
#pragma once

#include <functional>
#include <string_view>

#include "acquisition/calibration/calibrate.h"
#include "acquisition/session/scanner.h"

namespace vitrine {

// Puts the target into its `number`-th place, from 0, or has it put there; false: there is no
// other. It may stand on the table, so that it turns with it, or be held before it.
using PlaceTarget = std::function<Expected<bool>(int number)>;

struct TargetPictureOptions {
  double largest_angle = 50, angle_step = 5;  // degrees, of the table, either way
  // Called after each place with what has been seen so far and, where no picture shows the target
  // there, why: words for the operator.
  std::function<void(const std::string& seen)> progress = {};
  // Asked before each picture; may be empty.
  std::function<bool()> is_interrupted = {};
};

// Fails with a device's error, where it is interrupted (kState), or (kBadInput) where no picture
// shows the target ("target never seen"). Laser and motor are off on return.
Expected<CalibrationInput> picture_target(const Scanner& scanner, const Target& target,
                                          const PlaceTarget& place, EmergencyStop& stop,
                                          const TargetPictureOptions& options = {});

}  // namespace vitrine
