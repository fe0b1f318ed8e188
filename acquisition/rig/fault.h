// SPDX-License-Identifier: Apache-2.0
// Faults to simulate, and when they occur, counted in motions of the table.
#pragma once

#include <string_view>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::acquisition::rig {

// "That motion" is the motion of the table after which the fault occurs (RigFault::step).
enum class FaultKind {
  kLostPackets,    // from then on, one frame in twenty lacks packets
  kCameraUnplug,   // the camera is absent after that motion, and back after kUnplugged
  kUsbUnplug,      // the board is absent after that motion, and back after kUnplugged
  kMotorStall,     // after that motion the table does not turn until the board is restarted
  kMissedTrigger,  // the first frame after that motion is not sent
  kDrift,          // from then on, the laser shifts by kCreepMm with each motion
  kLaserOut,       // from then on, the laser stays dark when switched on
  kSecondStripe,   // from then on, the scanner's other laser lights as well
};

struct RigFault {
  FaultKind kind = FaultKind::kDrift;
  int step = 0;  // number of completed motions
};

inline constexpr double kCreepMm = 0.002;

// Parses "NAME" or "NAME@STEP", such as camera-unplug@20. Without a step, the fault is present from
// the start or occurs after the first motion, depending on its kind. Fails with kBadInput; the
// error lists the names.
Expected<RigFault> parse_fault(std::string_view text);

// due() returns whether a fault of that kind occurs exactly when the table has completed `turns`
// motions. lasting() returns whether it has occurred by then.
bool due(const std::vector<RigFault>& faults, FaultKind kind, int turns);
bool lasting(const std::vector<RigFault>& faults, FaultKind kind, int turns);

// Returns the laser's shift, in mm, after `turns` motions of the table.
double crept(const std::vector<RigFault>& faults, int turns);

}  // namespace vitrine::acquisition::rig
