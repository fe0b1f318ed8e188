// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/horus.h"

#include <gtest/gtest.h>

namespace vitrine::acquisition::horus {
namespace {

TEST(Horus, SaysWhatTheFirmwareReads) {
  EXPECT_EQ(turn(12.5, kCountedSpeed), "G1 X12.5000 F200");
  EXPECT_EQ(speed(kUncountedSpeed), "G1 F100");
  EXPECT_EQ(laser(1, true), "M71T1");
  EXPECT_EQ(laser(2, false), "M70T2");
}

TEST(Horus, GrantsATurnToASlowTableAndNoHourToAHundredTurns) {
  for (const int speed : {kCountedSpeed, kUncountedSpeed}) {
    EXPECT_GE(longest(-360, speed), 360 / kSlowestSpeed);
    EXPECT_GE(longest(36'000, speed), 36'000 / speed);
    EXPECT_LE(longest(36'000, speed), 15 * 60);
  }
}

TEST(Horus, TellsRepliesApart) {
  EXPECT_EQ(parse("ok").kind, ReplyKind::kOk);
  EXPECT_EQ(parse("error: Alarm lock").kind, ReplyKind::kRefusal);
  EXPECT_EQ(parse("ALARM: Abort during cycle").kind, ReplyKind::kAlarm);
  EXPECT_EQ(parse("['$H'|'$X' to unlock]").kind, ReplyKind::kAlarm);
  EXPECT_EQ(parse("[Caution: Unlocked]").kind, ReplyKind::kRemark);
  EXPECT_EQ(parse("Horus 0.2 ['$' for help]").text, "Horus 0.2");
  EXPECT_EQ(parse("Grbl 0.9j ['$' for help]").text, "Grbl 0.9j");
  EXPECT_EQ(parse("[G1 G54 T0 F12000.]").value, 12000);
  EXPECT_EQ(parse("[0.2:]").kind, ReplyKind::kVersion);
  EXPECT_EQ(parse("[0.9g.20140905:my board]").text, "0.9g.20140905");
  const Reply status = parse("<Run,MPos:-12.375,0.000>");
  EXPECT_EQ(status.kind, ReplyKind::kStatus);
  EXPECT_EQ(status.value, -12.375);
}

TEST(Horus, TakesNothingElseForAReply) {
  for (const char* line : {"", "okay", "o", "<Idle>", "<Idle,MPos:nan>", "<Idle,MPos:1e999>",
                           "<Idle,MPos:>", "M200", "\x1a"})
    EXPECT_EQ(parse(line).kind, ReplyKind::kUnknown) << line;
}

}  // namespace
}  // namespace vitrine::acquisition::horus
