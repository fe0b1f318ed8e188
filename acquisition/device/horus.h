// SPDX-License-Identifier: Apache-2.0
// The language of Horus firmware (a Grbl): lines of G-code at 115200 baud, each answered by lines
// and at last `ok`, a motion when it is complete.
#pragma once

#include <string>
#include <string_view>

namespace vitrine::horus {

inline constexpr int kBaud = 115200;
inline constexpr char kReset = 0x18;     // obeyed at once: halts, laser and motor off, then banner
inline constexpr char kAskStatus = '?';  // answered at once, without `ok`
inline constexpr char kAskModes[] = "$G";  // answered by the feed rate, among others
inline constexpr char kAskVersion[] = "$I";
inline constexpr char kUnlock[] = "$X";  // after a reset amid a motion
inline constexpr char kZeroHere[] = "G50";
inline constexpr char kMotorOn[] = "M17", kMotorOff[] = "M18";

// The feed rate is all that a restart forgets and a program can both set and ask for. So it says
// whether the counter means something: moves are made at one of two speeds, in degrees a second.
inline constexpr int kCountedSpeed = 200, kUncountedSpeed = 100;
// Degrees a second: a table may turn slower than it is asked to, yet hardly as slow as this.
inline constexpr int kSlowestSpeed = 10;
// Seconds in which a motion by so many degrees is over: up to a turn, as a scan needs, that of the
// slowest table; of more turns twice what they should take, or a stalled motor were waited for for
// an hour.
double longest(double degrees, int speed);

std::string turn(double degrees, int speed);
std::string speed(int degrees_per_second);
std::string laser(int which, bool on);  // 1 or 2

struct Reply {
  enum class Kind {
    kOk,
    kRefusal,  // text: why
    kBanner,   // text: name and version
    kVersion,  // text: the version
    kModes,    // value: the feed rate, degrees a minute; 0 since the last restart
    kStatus,   // value: where it stands, degrees
    kAlarm,    // locked or stopped
    kRemark,
    kUnknown,
  };
  Kind kind = Kind::kUnknown;
  std::string text;
  double value = 0;
};

// Of one line without its end; never fails.
Reply parse(std::string_view line);

}  // namespace vitrine::horus
