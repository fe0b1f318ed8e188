// SPDX-License-Identifier: Apache-2.0
// The camera and the board of a scanner, opened and ready to measure. Laser and motor are switched
// off when the LiveScanner is destroyed or its process ends.
#pragma once

#include <functional>
#include <memory>

#include "acquisition/device/board.h"
#include "acquisition/device/camera.h"
#include "acquisition/session/emergency_stop.h"

namespace vitrine::acquisition {

// Functions that open the devices. They are called again to reopen a device that was lost.
struct ScannerDevices {
  std::function<Expected<std::unique_ptr<Camera>>()> open_camera;
  std::function<Expected<std::unique_ptr<Board>>()> open_board;
};

struct FramePair {
  Frame dark, lit;  // the frames without and with laser, at one position of the table
};

// All calls, from open() to the destructor, must come from one thread. After an error, destroy this
// object and call open() again.
class LiveScanner {
 public:
  // Opens camera and board. `stop` must outlive the result.
  static Expected<LiveScanner> open(const ScannerDevices& devices, const CameraSettings& settings,
                                    EmergencyStop& stop);
  LiveScanner(LiveScanner&&) = default;
  LiveScanner& operator=(LiveScanner&&) = delete;
  ~LiveScanner();

  const CameraIdentity& camera() const { return camera_->identity(); }
  const BoardIdentity& board() const { return board_->identity(); }
  SensorRegion region() const { return camera_->region(); }

  // Reads the table's angle from the board. If the board does not know the angle, sets the angle to
  // `otherwise`.
  Expected<void> find_position(double otherwise);
  Expected<void> turn_to(double degrees) { return board_->turn_to(degrees); }
  // Switches laser and motor off and pauses the board's watchdog until the next motion.
  Expected<void> rest() { return board_->rest(); }
  // Takes one frame and leaves the laser as it is. The laser is initially off.
  Expected<Frame> capture() { return camera_->capture(); }
  // Takes one frame without laser and one with laser. If the two are identical, takes both again,
  // up to three times in all. Noise makes any two exposures differ, so identical frames mean that
  // the camera delivered one exposure twice.
  Expected<FramePair> capture_pair();

 private:
  Expected<FramePair> capture_once();
  LiveScanner(std::unique_ptr<Camera> camera, std::unique_ptr<Board> board, EmergencyStop& stop);

  std::unique_ptr<Camera> camera_;
  std::unique_ptr<Board> board_;
  EmergencyStop* stop_;
};

}  // namespace vitrine::acquisition
