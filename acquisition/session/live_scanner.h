// SPDX-License-Identifier: Apache-2.0
// Camera and board of a scanner, opened and ready to measure. Laser and motor are off once it is
// gone, however that comes about.
#pragma once

#include <functional>
#include <memory>

#include "acquisition/device/board.h"
#include "acquisition/device/camera.h"
#include "acquisition/session/emergency_stop.h"

namespace vitrine {

// How to open the devices; called again after each loss of one.
struct ScannerDevices {
  std::function<Expected<std::unique_ptr<Camera>>()> open_camera;
  std::function<Expected<std::unique_ptr<Board>>()> open_board;
};

struct FramePair {
  Frame dark, lit;  // laser off, laser on; of one position of the table
};

// Used by one thread, from open() to the end. An error of any call means that it is to be closed
// and opened anew.
class LiveScanner {
 public:
  // `stop` outlives it.
  static Expected<LiveScanner> open(const ScannerDevices& devices, const CameraSettings& settings,
                                    EmergencyStop& stop);
  LiveScanner(LiveScanner&&) = default;
  LiveScanner& operator=(LiveScanner&&) = delete;
  ~LiveScanner();

  const CameraIdentity& camera() const { return camera_->identity(); }
  const BoardIdentity& board() const { return board_->identity(); }
  SensorRegion region() const { return camera_->region(); }

  // Where the table stands; where the board cannot know that, it is told `otherwise`.
  Expected<void> find_position(double otherwise);
  Expected<void> turn_to(double degrees) { return board_->turn_to(degrees); }
  // Laser and motor off until the next turn; the watchdog rests, too.
  Expected<void> rest() { return board_->rest(); }
  Expected<Frame> capture() { return camera_->capture(); }  // as the laser is, off at first
  // Taken anew, three times in all, where both frames are the same one: equal down to their noise,
  // which alone makes two exposures differ.
  Expected<FramePair> capture_pair();

 private:
  Expected<FramePair> capture_once();
  LiveScanner(std::unique_ptr<Camera> camera, std::unique_ptr<Board> board, EmergencyStop& stop);

  std::unique_ptr<Camera> camera_;
  std::unique_ptr<Board> board_;
  EmergencyStop* stop_;
};

}  // namespace vitrine
