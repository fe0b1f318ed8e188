// SPDX-License-Identifier: Apache-2.0
// The language of FabScanPi firmware: lines that end with a line feed alone at 57600 baud, echoed,
// and answered by lines and at last the prompt `>`, a motion when it is complete. It neither counts
// nor can a motion be halted, but its laser and motor are off when the board has been restarted.
#pragma once

#include <string>

namespace vitrine::fabscan {

inline constexpr int kBaud = 57600;
inline constexpr char kPrompt = '>';
inline constexpr char kAskVersion[] = "M200";  // "v.20160506"
inline constexpr char kMotorOn[] = "M17", kMotorOff[] = "M18";
inline constexpr char kLaserOn[] = "M21", kLaserOff[] = "M22", kOtherLaserOff[] = "M20";

// The firmware counts in 16 bits, four times over: a longer motion is made of several.
inline constexpr int kMostSteps = 8000;
inline constexpr int kStepsPerSecond = 500;  // slower than it is, for deadlines

// A relative motion of at most kMostSteps either way.
std::string turn(int steps);

// Of a line that answers kAskVersion.
bool is_version(const std::string& line);

}  // namespace vitrine::fabscan
