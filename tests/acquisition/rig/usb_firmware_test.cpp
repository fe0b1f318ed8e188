// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "acquisition/rig_board/firmware.h"

namespace vitrine::acquisition::rig {
namespace {

constexpr FirmwareSettings kSlow = {.degrees_per_second = 10, .steps_per_turn = 3600};

std::string said(Firmware& firmware, std::string_view bytes, double now = 0) {
  firmware.receive(bytes, now);
  return firmware.take_output();
}

TEST(HorusFirmware, SaysOkWhenTheMotionIsComplete) {
  const auto board = horus_firmware(kSlow);
  board->restart(0);
  EXPECT_EQ(board->take_output(), "\r\nHorus 0.2 ['$' for help]\r\n");
  EXPECT_EQ(said(*board, "G1X10\n"), "error: Undefined feed rate\r\n");
  EXPECT_EQ(said(*board, "M17\nG1X20F200\n$G\n"), "ok\r\n");
  EXPECT_EQ(said(*board, "?", 1), "<Run,MPos:0.000>\r\n");
  EXPECT_NEAR(board->table(1), 10, 1e-9);
  EXPECT_NEAR(board->goal(), 20, 1e-9);
  board->advance(2);
  EXPECT_NEAR(board->goal(), 20, 1e-9);
  EXPECT_EQ(board->take_output(), "ok\r\n[G1 G54 T0 F12000.]\r\nok\r\n");
  EXPECT_EQ(said(*board, "?", 2), "<Idle,MPos:20.000>\r\n");
}

TEST(HorusFirmware, IsDarkAndLockedAfterAResetAmidAMotionAndForgetsItsSpeed) {
  const auto board = horus_firmware(kSlow);
  board->restart(0);
  said(*board, "M17\nM71T1\nG1X20F200\n");
  EXPECT_TRUE(board->laser());
  EXPECT_NE(said(*board, "\x18", 1).find("to unlock"), std::string::npos);
  EXPECT_FALSE(board->laser() || board->motor());
  EXPECT_NEAR(board->table(5), 10, 1e-9) << "halted";
  EXPECT_NEAR(board->goal(), 10, 1e-9);
  EXPECT_EQ(said(*board, "M17\n", 5), "error: Alarm lock\r\n");
  EXPECT_EQ(said(*board, "$X\n$G\n", 5), "[Caution: Unlocked]\r\nok\r\n[G1 G54 T0 F0.]\r\nok\r\n");
}

TEST(FabScanFirmware, EchoesAndPromptsWhenTheMotionIsComplete) {
  const auto board = fabscan_firmware(kSlow);
  board->restart(0);
  EXPECT_EQ(said(*board, "M200\nM17\n"), "M200\nv.20160506\r\n>M17\n>");
  EXPECT_EQ(said(*board, "G02 T100 F200\nM21\n"), "G02 T100 F200\n");
  EXPECT_FALSE(board->laser()) << "it reads nothing while it turns";
  board->advance(1);
  EXPECT_EQ(board->take_output(), ">M21\n>");
  EXPECT_TRUE(board->laser());
  EXPECT_NEAR(board->table(1), 10, 1e-9);
}

TEST(Firmware, ThatStallsNeverCompletesUntilItIsRestarted) {
  const auto board = horus_firmware({});
  board->restart(0);
  said(*board, "M17\n");
  board->stall();
  EXPECT_EQ(said(*board, "G1X5F10\n"), "");
  EXPECT_EQ(board->goal(), 0);
  board->advance(1e6);
  EXPECT_EQ(board->take_output(), "");
  board->restart(1e6);
  EXPECT_EQ(board->table(1e6), 0);
  board->take_output();
  EXPECT_EQ(said(*board, "M17\nG1X5F10\n", 1e6), "ok\r\nok\r\n");
}

}  // namespace
}  // namespace vitrine::acquisition::rig
