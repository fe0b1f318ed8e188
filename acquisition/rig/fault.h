// SPDX-License-Identifier: Apache-2.0
// Faults to simulate, and the time at which they occur, counted in motions of the table.
#pragma once

#include <string_view>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::acquisition::rig {

// The faults. `step` is RigFault::step: the number of the motion after which the fault occurs.
enum class FaultKind {
  kLostPackets,    // after motion `step`, one frame in twenty lacks packets
  kCameraUnplug,   // after motion `step`, the camera is absent for the time kUnplugged
  kUsbUnplug,      // after motion `step`, the board is absent for the time kUnplugged
  kMotorStall,     // after motion `step`, the table does not turn until the board restarts
  kMissedTrigger,  // the first frame after motion `step` is not sent
  kDrift,          // after motion `step`, the laser shifts by kCreepMm with each motion
  kLaserOut,       // after motion `step`, the laser stays dark when switched on
  kSecondStripe,   // after motion `step`, the scanner's other laser is on as well
};

struct RigFault {
  FaultKind kind = FaultKind::kDrift;
  int step = 0;  // number of completed motions after which the fault occurs
};

inline constexpr double kCreepMm = 0.002;  // in mm for each motion of the table

// Parses "NAME" or "NAME@STEP", such as camera-unplug@20. Without a step, the fault is present from
// the start or occurs after the first motion, depending on its kind. Fails with kBadInput; the
// error lists the names.
Expected<RigFault> parse_fault(std::string_view text);

// due() returns whether a fault of the given kind occurs right after motion number `turns`.
// lasting() returns whether such a fault has occurred by that time.
bool due(const std::vector<RigFault>& faults, FaultKind kind, int turns);
bool lasting(const std::vector<RigFault>& faults, FaultKind kind, int turns);

// Returns how far the fault kDrift has shifted the laser, in mm, after `turns` motions of the
// table.
double crept(const std::vector<RigFault>& faults, int turns);

}  // namespace vitrine::acquisition::rig
