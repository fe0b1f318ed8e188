// SPDX-License-Identifier: Apache-2.0
// The protocol of the Horus firmware (based on Grbl): lines of G-code at 115200 baud. The board
// answers each line with lines and then `ok`. If the line was a motion, the answer comes after its
// end.
#pragma once

#include <string>
#include <string_view>

namespace vitrine::acquisition::horus {

inline constexpr int kBaud = 115200;
// Takes effect at once: halts the motion, switches laser and motor off, then sends the banner.
inline constexpr char kReset = 0x18;
inline constexpr char kAskStatus = '?';    // the board answers at once, without `ok`
inline constexpr char kAskModes[] = "$G";  // asks for the modes, which include the feed rate
inline constexpr char kAskVersion[] = "$I";
inline constexpr char kUnlock[] = "$X";  // needed after a reset during a motion
inline constexpr char kZeroHere[] = "G50";
inline constexpr char kMotorOn[] = "M17", kMotorOff[] = "M18";

// Motions run at one of two speeds, in degrees per second. The speed of the last motion marks
// whether the step counter is valid. The board reports that speed as its feed rate, and a restart
// clears it.
inline constexpr int kCountedSpeed = 200, kUncountedSpeed = 100;
// Degrees per second: a lower bound of the speed of a slow table.
inline constexpr int kSlowestSpeed = 10;
// Returns the timeout, in seconds, of a motion by `degrees`. Up to one revolution, as in a scan,
// the timeout allows for the slowest table. For longer motions it is twice the expected time, so
// that a stalled motor is noticed within an hour.
double longest(double degrees, int speed);

std::string turn(double degrees, int speed);
std::string speed(int degrees_per_second);
std::string laser(int which, bool on);  // `which`: 1 or 2

enum class ReplyKind {
  kOk,
  kRefusal,  // text: the reason
  kBanner,   // text: name and version
  kVersion,  // text: the version
  kModes,    // value: the feed rate in degrees per minute; 0 since the last restart
  kStatus,   // value: the table's angle in degrees
  kAlarm,    // the board is locked or stopped
  kRemark,
  kUnknown,
};

struct Reply {
  ReplyKind kind = ReplyKind::kUnknown;
  std::string text;
  double value = 0;
};

// Parses one line without its line feed. Never fails.
Reply parse(std::string_view line);

}  // namespace vitrine::acquisition::horus
