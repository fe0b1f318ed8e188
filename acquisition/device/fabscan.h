// SPDX-License-Identifier: Apache-2.0
// The protocol of the FabScanPi firmware: 57600 baud. Lines end with a single line feed, and the
// board echoes them. The board answers with lines and then the prompt `>`. The answer to a motion
// comes when the motion ends. The board does not count steps and cannot halt a motion. A restart
// switches laser and motor off.
#pragma once

#include <string>

namespace vitrine::acquisition::fabscan {

inline constexpr int kBaud = 57600;
inline constexpr char kPrompt = '>';
inline constexpr char kAskVersion[] = "M200";  // the answer is "v.20160506"
inline constexpr char kMotorOn[] = "M17", kMotorOff[] = "M18";
inline constexpr char kLaserOn[] = "M21", kLaserOff[] = "M22", kOtherLaserOff[] = "M20";

// Largest number of steps in one command. Longer motions are split, because the firmware multiplies
// the steps by four and counts in 16 bits.
inline constexpr int kMostSteps = 8000;
// A lower bound of the table's speed, from which deadlines are computed.
inline constexpr int kStepsPerSecond = 500;

// Returns the command for a relative motion of at most kMostSteps, in either direction.
std::string turn(int steps);

// Returns whether the line is a valid answer to kAskVersion.
bool is_version(const std::string& line);

}  // namespace vitrine::acquisition::fabscan
