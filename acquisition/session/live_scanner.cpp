// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/live_scanner.h"

#include <fmt/format.h>

#include <utility>

namespace vitrine::acquisition {
namespace {

constexpr int kPairTries = 3;

// A picture counts as noisy if more than one pixel in this many differs from the pixel before it.
constexpr std::size_t kNoisy = 10;

// Returns whether a picture shows noise. Pictures show no noise if the lens cap is on, if they are
// over-exposed, or if the camera is an ideal simulated one.
bool shows_noise(const Frame& frame) {
  std::size_t changes = 0;
  for (std::size_t i = 1; i < frame.pixels.size(); ++i)
    changes += frame.pixels[i] != frame.pixels[i - 1] ? 1 : 0;
  return kNoisy * changes > frame.pixels.size();
}

}  // namespace

Expected<LiveScanner> LiveScanner::open(const ScannerDevices& devices,
                                        const CameraSettings& settings, EmergencyStop& stop) {
  auto board = devices.open_board();
  if (!board) return tl::unexpected(board.error());
  auto camera = devices.open_camera();
  if (!camera) return tl::unexpected(camera.error());
  if (auto done = (*camera)->configure(settings); !done) return tl::unexpected(done.error());
  return LiveScanner(std::move(*camera), std::move(*board), stop);
}

LiveScanner::LiveScanner(std::unique_ptr<Camera> camera, std::unique_ptr<Board> board,
                         EmergencyStop& stop)
    : camera_(std::move(camera)), board_(std::move(board)), stop_(&stop) {
  stop.guard(board_.get());
}

LiveScanner::~LiveScanner() {
  if (!board_) return;  // this object was moved from and has no devices
  // Ignores the error, because no caller is left to receive it. Closing the board switches laser
  // and motor off in any case.
  (void)board_->laser(false);
  (void)board_->rest();
  stop_->guard(nullptr);
}

Expected<void> LiveScanner::find_position(double otherwise) {
  const auto position = board_->position();
  if (!position) return tl::unexpected(position.error());
  return *position ? Expected<void>{} : board_->set_position(otherwise);
}

// Repeats the capture if the camera delivered the same picture twice, because the step would have
// no stripe. Equal pictures without noise are correct, however: the laser then hits no surface.
Expected<FramePair> LiveScanner::capture_pair() {
  auto pair = capture_once();
  for (int i = 1; i < kPairTries && pair && pair->dark == pair->lit; ++i)
    pair = capture_once();
  if (!pair || pair->dark != pair->lit || !shows_noise(pair->dark)) return pair;
  return fail(ErrorCode::kIo,
              fmt::format("camera {} delivers the same picture with the laser off and on; check "
                          "that the laser lights, and plug the camera in again",
                          camera().serial));
}

Expected<FramePair> LiveScanner::capture_once() {
  FramePair pair;
  auto dark = capture();
  if (!dark) return tl::unexpected(dark.error());
  pair.dark = std::move(*dark);
  if (auto on = board_->laser(true); !on) return tl::unexpected(on.error());
  auto lit = capture();
  if (!lit) return tl::unexpected(lit.error());
  pair.lit = std::move(*lit);
  if (auto off = board_->laser(false); !off) return tl::unexpected(off.error());
  return pair;
}

}  // namespace vitrine::acquisition
