// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/live_scanner.h"

#include <fmt/format.h>

#include <utility>

namespace vitrine::acquisition {
namespace {

constexpr int kPairTries = 3;

// A picture counts as noisy if more than one in this many pixels differs from the preceding pixel
// of the picture.
constexpr std::size_t kNoisy = 10;

// Returns whether a picture shows noise. Pictures taken with the lens cap on, over-exposed pictures
// and pictures of ideal cameras have none.
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
  if (!board_) return;  // this object was moved from
  // Closing the board switches laser and motor off anyway. No caller is left to receive an error.
  (void)board_->laser(false);
  (void)board_->rest();
  stop_->guard(nullptr);
}

Expected<void> LiveScanner::find_position(double otherwise) {
  const auto position = board_->position();
  if (!position) return tl::unexpected(position.error());
  return *position ? Expected<void>{} : board_->set_position(otherwise);
}

// If the camera delivered the same picture twice, the step would have no stripe, so the capture is
// repeated. Without noise, however, equal pictures are correct if the laser hits no surface.
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
