// SPDX-License-Identifier: Apache-2.0
// Tests a process that is suspended while it sends the commands of a motion. It must not complete
// the motion afterwards, because another process may have used the board since.
#include <gmock/gmock.h>

#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "acquisition/device/controller.h"

namespace vitrine::acquisition {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::chrono::milliseconds kAnswerTime{20};

// A port with a board that answers at once. When the port writes the command `fatal`, the process
// is suspended for longer than a board may take to answer.
class SuspendedPort : public SerialPort {
 public:
  const std::string& name() const override { return name_; }
  const std::string& serial() const override { return none_; }
  const std::string& socket() const override { return none_; }
  Expected<void> write(std::string_view bytes) override {
    sent.emplace_back(bytes);
    unread_ += answers(sent.back());
    if (bytes == fatal) std::this_thread::sleep_for(2 * kAnswerTime);
    return {};
  }
  Expected<std::string> read(Clock::time_point) override { return std::exchange(unread_, ""); }
  void cancel() noexcept override {}
  Expected<void> restart_controller() override { return {}; }

  std::string fatal;
  std::string (*answers)(const std::string& command) = nullptr;
  std::vector<std::string> sent;

 private:
  const std::string name_ = "USB board", none_;
  std::string unread_;
};

std::string horus_answer(const std::string& command) {
  return command == "?" ? "<Idle,MPos:0.000>\n" : "ok\n";
}

std::string horus_greeting(const std::string& command) {
  if (command == "\n$G\n") return "[G0 F1.000]\nok\n";
  return command == "\x18" ? "Horus 0.2 ['$' for help]\n" : "ok\n";
}

std::string fabscan_answer(const std::string& command) {
  return command + ">\n";
}

TEST(SuspendedProcess, DoesNotMoveAHorusTableAfterItHasAskedForThePosition) {
  SuspendedPort port;
  port.fatal = "?";
  port.answers = horus_answer;
  const auto board = make_horus(port, kAnswerTime);
  EXPECT_THAT(board->turn_to(90).error().message, HasSubstr("does not answer '?' in time"));
  EXPECT_THAT(port.sent, ElementsAre("?"));
}

TEST(SuspendedProcess, DoesNotMoveAHorusTableAfterItHasSwitchedTheMotorOn) {
  SuspendedPort port;
  port.fatal = "M17\n";
  port.answers = horus_answer;
  const auto board = make_horus(port, kAnswerTime);
  EXPECT_THAT(board->turn_to(90).error().message, HasSubstr("does not answer 'M17' in time"));
  EXPECT_THAT(port.sent, ElementsAre("?", "M17\n"));
}

TEST(SuspendedProcess, DoesNotUnlockAHorusBoardAfterItHasRestartedIt) {
  SuspendedPort port;
  port.answers = horus_greeting;
  const auto board = make_horus(port, kAnswerTime);
  EXPECT_EQ(board->greet().value_or("no answer"), "Horus 0.2");
  port.fatal = "\x18";
  port.sent.clear();
  EXPECT_THAT(board->greet().error().message,
              HasSubstr("USB board does not answer; check its power"));
  EXPECT_THAT(port.sent, ElementsAre("\n$G\n", "\x18"));
}

TEST(SuspendedProcess, DoesNotMoveAFabScanTableAfterItHasSwitchedTheMotorOn) {
  SuspendedPort port;
  port.fatal = "M17\n";
  port.answers = fabscan_answer;
  const auto board = make_fabscan(port, kAnswerTime, 3200);
  EXPECT_THAT(board->turn_to(90).error().message, HasSubstr("does not answer 'M17' in time"));
  EXPECT_THAT(port.sent, ElementsAre("M17\n"));
}

}  // namespace
}  // namespace vitrine::acquisition
