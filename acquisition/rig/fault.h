// SPDX-License-Identifier: Apache-2.0
// What is to go wrong, and when: counted in motions of the table.
#pragma once

#include <string_view>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::rig {

enum class FaultKind {
  kLostPackets,    // from then on one frame in twenty lacks packets
  kCameraUnplug,   // gone after that motion, back after kUnplugged
  kUsbUnplug,      // likewise, the board
  kMotorStall,     // after that motion the table does not turn until the board is restarted
  kMissedTrigger,  // the first frame after that motion is not sent
  kDrift,          // from then on the laser creeps by kCreepMm a motion
  kLaserOut,       // from then on it does not light when it is told to
  kSecondStripe,   // from then on the scanner's other laser lights with it
};

struct Fault {
  FaultKind kind = FaultKind::kDrift;
  int step = 0;  // motions that were completed
};

inline constexpr double kCreepMm = 0.002;

// "NAME" or "NAME@STEP", such as camera-unplug@20; without a step after the first motion, or from
// the start. Fails (kBadInput) with the names there are.
Expected<Fault> parse_fault(std::string_view text);

// Whether that kind is due at exactly that motion, or since an earlier one.
bool due(const std::vector<Fault>& faults, FaultKind kind, int turns);
bool lasting(const std::vector<Fault>& faults, FaultKind kind, int turns);

// How far the laser has crept, mm.
double crept(const std::vector<Fault>& faults, int turns);

}  // namespace vitrine::rig
