// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/fenced_devices.h"

#include <utility>

namespace vitrine::server {
namespace {

using May = std::function<Expected<void>()>;

class FencedBoard final : public acquisition::Board {
 public:
  FencedBoard(std::unique_ptr<acquisition::Board> board, May may)
      : board_(std::move(board)), may_(std::move(may)) {}

  const acquisition::BoardIdentity& identity() const override { return board_->identity(); }
  Expected<std::optional<double>> position() override {
    return may_().and_then([this] { return board_->position(); });
  }
  Expected<void> set_position(double degrees) override {
    return may_().and_then([&] { return board_->set_position(degrees); });
  }
  Expected<void> turn_to(double degrees) override {
    return may_().and_then([&] { return board_->turn_to(degrees); });
  }
  Expected<void> laser(bool on) override {
    return may_().and_then([&] { return board_->laser(on); });
  }
  Expected<void> rest() override {
    return may_().and_then([this] { return board_->rest(); });
  }
  // An emergency stop is carried out even if this daemon may not command the scanner.
  void emergency_stop() noexcept override { board_->emergency_stop(); }

 private:
  const std::unique_ptr<acquisition::Board> board_;
  const May may_;
};

}  // namespace

acquisition::ScannerDevices fenced(acquisition::ScannerDevices devices, const May& may) {
  acquisition::ScannerDevices fenced;
  fenced.open_camera = [open = std::move(devices.open_camera), may] {
    return may().and_then([&] { return open(); });
  };
  fenced.open_board = [open = std::move(devices.open_board),
                       may]() -> Expected<std::unique_ptr<acquisition::Board>> {
    auto board = may().and_then([&] { return open(); });
    if (!board) return board;
    return std::make_unique<FencedBoard>(std::move(*board), may);
  };
  return fenced;
}

}  // namespace vitrine::server
