// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/board.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <sstream>
#include <thread>

#include "acquisition/rig/usb_rig.h"
#include "support/temporary_folder.h"

namespace vitrine::acquisition {
namespace {

using std::chrono::milliseconds;
using test::UsbRig;

BoardOptions quick() {
  return {.response_timeout = milliseconds(500), .guardian = VITRINE_BIN_DIR "/vitrine-guardian"};
}

BoardSelector selector_of(const std::string& dialect, const std::string& transport) {
  BoardSelector selector{.dialect = *parse_board_dialect(dialect), .serial = "RIG0001"};
  if (transport == "cdc") selector.vendor = 0x2341, selector.product = 0x0043;
  if (transport == "ftdi") selector.vendor = 0x0403, selector.product = 0x6001;
  if (transport == "ch34x") selector.vendor = 0x1a86, selector.product = 0x7523;
  return selector;
}

struct BoardKind {
  std::string dialect, transport;
};

void PrintTo(const BoardKind& kind, std::ostream* out) {
  *out << kind.dialect << ' ' << kind.transport;
}

class EveryBoard : public testing::TestWithParam<BoardKind> {
 protected:
  std::string name() const { return GetParam().dialect + ' ' + GetParam().transport; }
  Expected<std::unique_ptr<Board>> open() const {
    return open_board(selector_of(GetParam().dialect, GetParam().transport), quick());
  }
  void wait_until_it_turns() const {
    for (const double at = rig_.table(); rig_.table() == at;)
      std::this_thread::sleep_for(milliseconds(1));
  }
  UsbRig rig_;
};

INSTANTIATE_TEST_SUITE_P(, EveryBoard,
                         testing::Values(BoardKind{"horus", "cdc"}, BoardKind{"horus", "ftdi"},
                                         BoardKind{"horus", "ch34x"}, BoardKind{"fabscan", "cdc"},
                                         BoardKind{"fabscan", "ftdi"},
                                         BoardKind{"fabscan", "ch34x"}),
                         [](const auto& one) {
                           return one.param.dialect + "_" + one.param.transport;
                         });

TEST_P(EveryBoard, TurnsAndLights) {
  ASSERT_EQ(rig_.ask("plug " + name()), "ok");
  auto board = open();
  ASSERT_TRUE(board) << board.error().message;
  EXPECT_EQ((*board)->identity().dialect, GetParam().dialect);
  EXPECT_EQ((*board)->identity().serial, "RIG0001");
  EXPECT_EQ(*(*board)->position(), std::nullopt);

  const double before = rig_.table();
  ASSERT_TRUE((*board)->set_position(0));
  ASSERT_TRUE((*board)->turn_to(45));
  EXPECT_NEAR(rig_.table() - before, 45, 1e-3);
  EXPECT_NEAR(**(*board)->position(), 45, 1e-3);
  ASSERT_TRUE((*board)->laser(true));
  EXPECT_EQ(rig_.ask("laser"), "on");
  EXPECT_EQ(rig_.ask("motor"), "on");
  ASSERT_TRUE((*board)->laser(false));
  EXPECT_EQ(rig_.ask("laser"), "off");
  ASSERT_TRUE((*board)->turn_to(-30));
  EXPECT_NEAR(rig_.table() - before, -30, 360.0 / 3200);
}

TEST_P(EveryBoard, RecordsWhatLaserAndMotorDo) {
  ASSERT_EQ(rig_.ask("plug " + name()), "ok");
  BoardOptions options = quick();
  EXPECT_EQ(options.power->read().laser, LaserState::kUnknown);
  auto board = open_board(selector_of(GetParam().dialect, GetParam().transport), options);
  ASSERT_TRUE(board) << board.error().message;
  const auto is = [&](LaserState laser, MotorState motor) {
    return options.power->read().laser == laser && options.power->read().motor == motor;
  };
  EXPECT_TRUE(is(LaserState::kOff, MotorState::kOff));
  ASSERT_TRUE((*board)->laser(true));
  EXPECT_TRUE(is(LaserState::kOn, MotorState::kOff));
  ASSERT_TRUE((*board)->turn_to(5));
  EXPECT_TRUE(is(LaserState::kOn, MotorState::kHolding));
  ASSERT_TRUE((*board)->laser(false));
  EXPECT_TRUE(is(LaserState::kOff, MotorState::kHolding));
  ASSERT_TRUE((*board)->rest());
  EXPECT_TRUE(is(LaserState::kOff, MotorState::kOff));
  ASSERT_TRUE((*board)->turn_to(10));
  ASSERT_TRUE((*board)->laser(true));
  (*board)->emergency_stop();
  EXPECT_TRUE(is(LaserState::kOff, MotorState::kOff));
  EXPECT_FALSE((*board)->laser(true));
  EXPECT_TRUE(is(LaserState::kOff, MotorState::kOff));
}

TEST_P(EveryBoard, WaitsForATableThatTurnsSlowly) {
  ASSERT_EQ(rig_.ask("plug " + name() + " 40"), "ok");
  auto board = open();
  ASSERT_TRUE(board) << board.error().message;
  ASSERT_TRUE((*board)->set_position(0));
  const auto turned = (*board)->turn_to(60);
  EXPECT_TRUE(turned) << turned.error().message;
}

TEST_P(EveryBoard, IsDarkAfterItWasClosed) {
  ASSERT_EQ(rig_.ask("plug " + name()), "ok");
  {
    auto board = open();
    ASSERT_TRUE(board) << board.error().message;
    ASSERT_TRUE((*board)->turn_to(1));
    ASSERT_TRUE((*board)->laser(true));
  }
  EXPECT_EQ(rig_.ask("laser"), "off");
  EXPECT_EQ(rig_.ask("motor"), "off");
}

TEST_P(EveryBoard, StandsAsToldAfterSetPosition) {
  ASSERT_EQ(rig_.ask("plug " + name()), "ok");
  const double before = rig_.table();
  auto board = open();
  ASSERT_TRUE(board) << board.error().message;
  ASSERT_TRUE((*board)->set_position(90));
  EXPECT_NEAR(rig_.table(), before, 1e-3);
  EXPECT_NEAR(**(*board)->position(), 90, 1e-3);
  ASSERT_TRUE((*board)->turn_to(135));
  EXPECT_NEAR(rig_.table() - before, 45, 1e-3);
}

TEST_P(EveryBoard, GoesOnWithinHalfAMotorStepHoweverOftenItIsOpenedAnew) {
  ASSERT_EQ(rig_.ask("plug " + name()), "ok");
  const double before = rig_.table();
  double at = 0;
  // These angles are 4.4, 8.9 and 13.3 motor steps. A FabScan rounds them to whole steps.
  for (const double next : {0.5, 1.0, 1.5}) {
    auto board = open();
    ASSERT_TRUE(board) << board.error().message;
    if (!*(*board)->position()) {
      ASSERT_TRUE((*board)->set_position(at));
    }
    ASSERT_TRUE((*board)->turn_to(next));
    at = next;
  }
  EXPECT_NEAR(rig_.table() - before, at, 180.0 / 3200);
}

TEST_P(EveryBoard, TellsItsFirmwareEachTimeItIsOpened) {
  ASSERT_EQ(rig_.ask("plug " + name()), "ok");
  const std::string banner = GetParam().dialect == "horus" ? "Horus 0.2" : "FabScan v.20160506";
  for (int i = 0; i < 2; ++i) {
    auto board = open();
    ASSERT_TRUE(board) << board.error().message;
    EXPECT_EQ((*board)->identity().firmware, banner);
    // A board with a known position is not restarted when it is opened again, so it keeps the
    // position.
    ASSERT_TRUE((*board)->set_position(0));
  }
}

TEST_P(EveryBoard, IsGoneWhenUnpluggedAmidAMotionAndServesAnewWhenItIsBack) {
  ASSERT_EQ(rig_.ask("plug " + name() + " 10"), "ok");
  {
    auto board = open();
    ASSERT_TRUE(board) << board.error().message;
    Expected<void> turned;
    std::thread turning([&] { turned = (*board)->turn_to(3600); });
    while (rig_.table() == 0)
      std::this_thread::sleep_for(milliseconds(1));
    EXPECT_EQ(rig_.ask("unplug"), "ok");
    turning.join();
    ASSERT_FALSE(turned);
    EXPECT_EQ(turned.error().code, ErrorCode::kIo);
    EXPECT_NE(turned.error().message.find("is gone; check its cable"), std::string::npos)
        << turned.error().message;
    EXPECT_FALSE((*board)->laser(true));
  }
  const auto absent = open();
  ASSERT_FALSE(absent);
  EXPECT_NE(absent.error().message.find("is not there"), std::string::npos);

  ASSERT_EQ(rig_.ask("plug " + name()), "ok");
  auto board = open();
  ASSERT_TRUE(board) << board.error().message;
  EXPECT_EQ(*(*board)->position(), std::nullopt) << "it has been without power";
  EXPECT_TRUE((*board)->turn_to(10));
}

TEST_P(EveryBoard, IsHaltedInTheMiddleOfAMotionByAnEmergencyStop) {
  ASSERT_EQ(rig_.ask("plug " + name() + " 10"), "ok");
  auto board = open();
  ASSERT_TRUE(board) << board.error().message;
  ASSERT_TRUE((*board)->set_position(0));
  ASSERT_TRUE((*board)->laser(true));
  const double before = rig_.table();
  Expected<void> turned;
  std::thread turning([&] { turned = (*board)->turn_to(3600); });
  while (rig_.table() == before)
    std::this_thread::sleep_for(milliseconds(1));
  const auto begin = std::chrono::steady_clock::now();
  (*board)->emergency_stop();
  while (rig_.ask("laser") == "on" || rig_.ask("motor") == "on")
    std::this_thread::sleep_for(milliseconds(1));
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
  std::printf("laser and motor off %.1f ms after the emergency stop\n", taken.count());
  turning.join();
  EXPECT_LT(rig_.table() - before, 3500);
  ASSERT_FALSE(turned);
  EXPECT_EQ(turned.error().code, ErrorCode::kState) << turned.error().message;
  EXPECT_EQ((*board)->laser(true).error().code, ErrorCode::kState);
  EXPECT_EQ(rig_.ask("laser"), "off");

  board->reset();
  auto again = open();
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(*(*again)->position(), std::nullopt) << "it was halted between two steps";
  EXPECT_TRUE((*again)->turn_to((*again)->position().value().value_or(0)));
}

TEST_P(EveryBoard, StaysOffWhenACallBeginsAsItIsStopped) {
  ASSERT_EQ(rig_.ask("plug " + name() + " 10"), "ok");
  for (int i = 0; i < 10; ++i) {
    // After a stop, a guardian process switches the previous board off. open() succeeds only after
    // the guardian has done so.
    auto board = open();
    ASSERT_TRUE(board) << board.error().message;
    std::thread turning([&] { (void)(*board)->turn_to(3600); });
    (*board)->emergency_stop();
    turning.join();
    EXPECT_EQ((*board)->laser(true).error().code, ErrorCode::kState);
    while (rig_.ask("motor") == "on")
      std::this_thread::sleep_for(milliseconds(1));
    EXPECT_EQ(rig_.ask("laser"), "off");
  }
}

TEST_P(EveryBoard, FailsAndGoesDarkWhenTheMotorStalls) {
  ASSERT_EQ(rig_.ask("plug " + name()), "ok");
  auto board = open();
  ASSERT_TRUE(board) << board.error().message;
  ASSERT_TRUE((*board)->laser(true));
  ASSERT_EQ(rig_.ask("stall"), "ok");
  const auto turned = (*board)->turn_to(5);
  ASSERT_FALSE(turned);
  EXPECT_NE(turned.error().message.find("does not answer 'G"), std::string::npos)
      << turned.error().message;
  EXPECT_EQ(rig_.ask("laser"), "off");
  EXPECT_EQ(rig_.ask("motor"), "off");
  EXPECT_EQ((*board)->laser(true).error().message, turned.error().message);
}

TEST_P(EveryBoard, FailsAndGoesDarkWhenItTalksNonsense) {
  ASSERT_EQ(rig_.ask("plug " + name()), "ok");
  auto board = open();
  ASSERT_TRUE(board) << board.error().message;
  ASSERT_TRUE((*board)->laser(true));
  ASSERT_EQ(rig_.ask("babble \x81\x82 what " + std::string(5000, 'x')), "ok");
  const auto turned = (*board)->turn_to(5);
  ASSERT_FALSE(turned);
  EXPECT_NE(turned.error().message.find("check its cable and its firmware"), std::string::npos)
      << turned.error().message;
  EXPECT_EQ(rig_.ask("laser"), "off");
}

TEST_P(EveryBoard, IsSwitchedOffByTheWatchdogUnlessItRests) {
  ASSERT_EQ(rig_.ask("plug " + name()), "ok");
  BoardOptions options = quick();
  options.watchdog = milliseconds(300);
  auto board = open_board(selector_of(GetParam().dialect, GetParam().transport), options);
  ASSERT_TRUE(board) << board.error().message;
  ASSERT_TRUE((*board)->laser(true));
  ASSERT_TRUE((*board)->rest());
  EXPECT_EQ(rig_.ask("laser"), "off");
  ASSERT_TRUE((*board)->laser(true));
  while (rig_.ask("laser") == "on")
    std::this_thread::sleep_for(milliseconds(1));
  while (rig_.ask("motor") == "on")
    std::this_thread::sleep_for(milliseconds(1));
  const auto late = (*board)->laser(true);
  ASSERT_FALSE(late);
  EXPECT_NE(late.error().message.find("no call came for 300 ms"), std::string::npos);
  EXPECT_EQ(rig_.ask("laser"), "off");
}

TEST_P(EveryBoard, IsSwitchedOffWhenItsProcessIsKilled) {
  ASSERT_EQ(rig_.ask("plug " + name()), "ok");
  const pid_t child = ::fork();
  if (child == 0) {
    auto board = open();
    if (board && (*board)->set_position(0) && (*board)->turn_to(30) && (*board)->laser(true))
      ::pause();
    ::_exit(1);
  }
  while (rig_.ask("laser") == "off" && ::waitpid(child, nullptr, WNOHANG) == 0)
    std::this_thread::sleep_for(milliseconds(1));
  ASSERT_EQ(rig_.ask("laser"), "on");
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  while (rig_.ask("laser") == "on" || rig_.ask("motor") == "on")
    std::this_thread::sleep_for(milliseconds(1));

  auto board = open();
  ASSERT_TRUE(board) << board.error().message;
  if (GetParam().dialect == "horus") {
    const auto at = (*board)->position();
    ASSERT_TRUE(at && *at) << "the board has not been restarted";
    EXPECT_NEAR(**at, 30, 1e-3);
  }
}

TEST(Board, IsHeldByOneAtATime) {
  const UsbRig rig;
  ASSERT_EQ(rig.ask("plug horus cdc"), "ok");
  auto board = open_board(selector_of("horus", "cdc"), quick());
  ASSERT_TRUE(board) << board.error().message;
  const auto second = open_board(selector_of("horus", "cdc"), quick());
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("is in use; end the other program"), std::string::npos)
      << second.error().message;
  EXPECT_TRUE((*board)->turn_to(3)) << "undisturbed";
}

TEST(Board, OfAnotherKindIsToldByWhatItSays) {
  const UsbRig rig;
  for (const auto& [actual, believed] :
       {std::pair("fabscan", "horus"), std::pair("horus", "fabscan")}) {
    ASSERT_EQ(rig.ask(std::string("plug ") + actual + " cdc"), "ok");
    const auto board = open_board(selector_of(believed, "cdc"), quick());
    ASSERT_FALSE(board);
    EXPECT_EQ(board.error().code, ErrorCode::kBadInput) << board.error().message;
    EXPECT_NE(board.error().message.find("check vendor, product"), std::string::npos)
        << board.error().message;
  }
}

TEST(Board, IsFoundBySerialNumberAndByPort) {
  const UsbRig rig;
  ASSERT_EQ(rig.ask("plug horus cdc"), "ok");
  BoardSelector selector = selector_of("horus", "cdc");
  selector.serial = "RIG0002";
  EXPECT_NE(open_board(selector, quick()).error().message.find("RIG0002 is not there"),
            std::string::npos);
  selector.serial.clear();
  selector.port = "1-3";
  EXPECT_NE(open_board(selector, quick()).error().message.find("in socket 1-3 is not there"),
            std::string::npos);
  selector.port = "1-2";
  EXPECT_TRUE(open_board(selector, quick()));
}

// A fake guardian, the process that switches off an abandoned board. It logs its arguments, which
// name the board, and the word that it receives when it is dismissed.
class WritingGuardian {
 public:
  WritingGuardian() {
    std::ofstream(program()) << "#!/bin/sh\nexec 3<&0\necho \"$@\" >$0.board\n"
                                "{ head -c 1 <&3 >$0.word; mv $0.word $0.end; } &\n";
    std::filesystem::permissions(program(), std::filesystem::perms::owner_all);
  }
  std::filesystem::path program() const { return folder_.path() / "guardian"; }
  std::string board() const { return text_of("guardian.board"); }
  // Waits until the guardian has been dismissed, and returns the last word that it received.
  std::string last_word() const {
    while (!std::filesystem::exists(folder_.path() / "guardian.end"))
      std::this_thread::sleep_for(milliseconds(1));
    return text_of("guardian.end");
  }

 private:
  std::string text_of(const char* name) const {
    std::ostringstream text;
    text << std::ifstream(folder_.path() / name).rdbuf();
    return text.str();
  }

  test::TemporaryFolder folder_;
};

TEST(Guardian, IsDismissedOnceTheBoardHasSaidThatItIsOff) {
  const UsbRig rig;
  const WritingGuardian guardian;
  ASSERT_EQ(rig.ask("plug horus cdc"), "ok");
  ASSERT_TRUE(open_board(selector_of("horus", "cdc"), {.guardian = guardian.program()}));
  EXPECT_EQ(guardian.last_word(), "d");
}

TEST(Guardian, IsNotDismissedWhereNobodyKnowsThatTheLaserIsOff) {
  const UsbRig rig;
  for (const bool unplugged : {false, true}) {
    const WritingGuardian guardian;
    ASSERT_EQ(rig.ask("plug horus cdc"), "ok");
    auto board = open_board(selector_of("horus", "cdc"), {.guardian = guardian.program()});
    ASSERT_TRUE(board) << board.error().message;
    ASSERT_TRUE((*board)->laser(true));
    if (unplugged) {
      ASSERT_EQ(rig.ask("unplug"), "ok");
    } else {
      (*board)->emergency_stop();
    }
    EXPECT_FALSE((*board)->laser(true));
    board->reset();
    EXPECT_EQ(guardian.last_word(), "");
  }
}

TEST(Guardian, IsToldWhichBoardWasOpened) {
  const UsbRig rig;
  const WritingGuardian guardian;
  ASSERT_EQ(rig.ask("plug horus cdc"), "ok");
  BoardSelector any = selector_of("horus", "cdc");
  any.serial.clear();
  ASSERT_TRUE(open_board(any, {.guardian = guardian.program()}));
  EXPECT_EQ(guardian.board(), "horus 9025 67 RIG0001 1-2\n");
}

TEST(Guardian, LeavesNoLaserUnguardedWhenItDies) {
  const UsbRig rig;
  ASSERT_EQ(rig.ask("plug horus cdc"), "ok");
  auto board = open_board(selector_of("horus", "cdc"), {.guardian = "/bin/true"});
  ASSERT_TRUE(board) << board.error().message;
  const auto lit = (*board)->laser(true);
  ASSERT_FALSE(lit);
  EXPECT_NE(lit.error().message.find("the process that guards its laser has ended"),
            std::string::npos)
      << lit.error().message;
  EXPECT_EQ(rig.ask("laser"), "off");
}

TEST(Board, IsNotOpenedWithoutItsGuardian) {
  const UsbRig rig;
  ASSERT_EQ(rig.ask("plug horus cdc"), "ok");
  BoardOptions options = quick();
  options.guardian = "/nowhere/vitrine-guardian";
  const auto board = open_board(selector_of("horus", "cdc"), options);
  ASSERT_FALSE(board);
  EXPECT_NE(board.error().message.find("install it beside vitrine"), std::string::npos)
      << board.error().message;
}

}  // namespace
}  // namespace vitrine::acquisition
