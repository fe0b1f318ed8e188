// SPDX-License-Identifier: Apache-2.0
// The protocol of the Horus firmware (based on Grbl): lines of G-code at 115200 baud. The board
// answers each line with lines and then `ok`. The answer to a motion comes when the motion ends.
#pragma once

#include <string>
#include <string_view>

namespace vitrine::acquisition::horus {

inline constexpr int kBaud = 115200;
// Reset character. It takes effect at once: the board halts the motion, switches laser and motor
// off, and sends its banner.
inline constexpr char kReset = 0x18;
inline constexpr char kAskStatus = '?';    // the board answers at once, without `ok`
inline constexpr char kAskModes[] = "$G";  // asks for the modes, which include the feed rate
inline constexpr char kAskVersion[] = "$I";
inline constexpr char kUnlock[] = "$X";  // unlocks the board, which a reset during a motion locks
inline constexpr char kZeroHere[] = "G50";
inline constexpr char kMotorOn[] = "M17", kMotorOff[] = "M18";

// Speeds of the table, in degrees per second. A motion at kCountedSpeed marks the board's step
// counter as valid, a motion at kUncountedSpeed as invalid. The board reports the last speed as its
// feed rate; a restart clears the feed rate.
inline constexpr int kCountedSpeed = 200, kUncountedSpeed = 100;
// A lower bound of the table's speed, in degrees per second.
inline constexpr int kSlowestSpeed = 10;
// Returns the timeout, in seconds, of a motion by `degrees`. For up to one revolution, as in a
// scan, the timeout allows for the slowest table. For longer motions the timeout is twice the
// expected time, so that a stalled motor is noticed within an hour.
double longest(double degrees, int speed);

std::string turn(double degrees, int speed);
std::string speed(int degrees_per_second);
std::string laser(int which, bool on);  // `which`: the laser's number, 1 or 2

enum class ReplyKind {
  kOk,
  kRefusal,  // Reply::text has the reason
  kBanner,   // Reply::text has name and version
  kVersion,  // Reply::text has the version
  kModes,    // Reply::value is the feed rate in degrees per minute; 0 after a restart
  kStatus,   // Reply::value is the table's angle in degrees
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
