// SPDX-License-Identifier: Apache-2.0
// Takes the pictures for a calibration. They show the target in many placements, both without laser
// and with the laser's line on the target.
#pragma once

#include <functional>
#include <string_view>

#include "acquisition/calibration/calibrate.h"
#include "acquisition/session/scanner.h"

namespace vitrine::acquisition {

// Moves the target to placement `number`, counted from 0, or asks the operator to do so. Returns
// false if there are no more placements. The target may stand on the table and turn with it, or be
// held in front of the table.
using PlaceTarget = std::function<Expected<bool>(int number)>;

struct TargetPictureOptions {
  double largest_angle = 50,
         angle_step = 5;  // degrees by which the table turns, in either direction
  // Called after each placement; may be empty. `seen` is a message for the operator. It says how
  // many pictures show the target so far. If no picture of this placement shows the target, it also
  // says why.
  std::function<void(const std::string& seen)> progress = {};
  // Called before each picture. If it returns true, picture_target() stops. May be empty.
  std::function<bool()> is_interrupted = {};
};

// Takes all pictures. Fails with the error of a device, with kState if interrupted, or with
// kBadInput if no picture shows the target ("target never seen"). Laser and motor are off when the
// function returns.
Expected<CalibrationInput> picture_target(const Scanner& scanner, const CharucoTarget& target,
                                          const PlaceTarget& place, EmergencyStop& stop,
                                          const TargetPictureOptions& options = {});

}  // namespace vitrine::acquisition
