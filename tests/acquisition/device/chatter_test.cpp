// SPDX-License-Identifier: Apache-2.0
// Tests boards that never stop sending.
#include <gmock/gmock.h>

#include <utility>

#include "acquisition/device/controller.h"

namespace vitrine::acquisition {
namespace {

using testing::HasSubstr;

// A port that echoes its input. Each read also returns a line that nobody requested.
class ChatteringPort : public SerialPort {
 public:
  const std::string& name() const override { return name_; }
  const std::string& serial() const override { return none_; }
  const std::string& socket() const override { return none_; }
  Expected<void> write(std::string_view bytes) override {
    if (echoes) unread_ += bytes;
    return {};
  }
  Expected<std::string> read(Clock::time_point) override {
    return std::exchange(unread_, "") + "[still here]\n";
  }
  void cancel() noexcept override {}
  Expected<void> restart_controller() override { return {}; }

  bool echoes = false;

 private:
  const std::string name_ = "USB board", none_;
  std::string unread_;
};

constexpr std::chrono::milliseconds kTimeout{5};

TEST(ChatteringBoard, HorusDoesNotAnswerInTime) {
  ChatteringPort port;
  const auto board = make_horus(port, kTimeout);
  EXPECT_THAT(board->laser(true).error().message, HasSubstr("does not answer 'M71T1' in time"));
  EXPECT_THAT(board->position().error().message, HasSubstr("does not answer '?' in time"));
}

TEST(ChatteringBoard, FabScanDoesNotAnswerInTime) {
  ChatteringPort port;
  port.echoes = true;
  const auto board = make_fabscan(port, kTimeout, 3200);
  EXPECT_THAT(board->laser(true).error().message, HasSubstr("does not answer 'M21' in time"));
}

}  // namespace
}  // namespace vitrine::acquisition
