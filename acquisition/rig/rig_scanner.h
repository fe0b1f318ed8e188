// SPDX-License-Identifier: Apache-2.0
// The simulated scanner: table, laser, camera and board, with the faults that the options request.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "acquisition/rig/cable.h"
#include "acquisition/rig/fault.h"
#include "acquisition/rig/gige_camera.h"
#include "acquisition/rig_board/usb_board.h"
#include "acquisition/rig_optics/renderer.h"
#include "acquisition/rig_optics/stage.h"

namespace vitrine::acquisition::rig {

struct RigScannerOptions {
  // The object on the table, which must outlive the scanner. If null, the scene is empty and
  // reflects no light.
  const Subject* object = nullptr;
  Realism realism;
  std::vector<RigFault> faults;
  std::string camera_address = "127.0.0.1";
  bool is_fabscan = false;  // whether the board speaks FabScan instead of Horus
  // Speed of the table. If 0, motions complete at once.
  double degrees_per_second = 0;
  // File that keeps the table's angle. Empty: the table starts at 0 degrees.
  std::filesystem::path table;
  // File to which all commands to the board are written. Empty: no file.
  std::filesystem::path commands;
};

// Return the camera's serial number and the board's settings. They depend only on the arguments, so
// a restarted rig simulates the same scanner.
std::string camera_serial(std::uint64_t seed);
UsbBoardSettings board_settings(std::uint64_t seed, bool fabscan);

class RigScanner {
 public:
  static Expected<std::unique_ptr<RigScanner>> start(const RigScannerOptions& options);

  // The scene, which the board and the operator change and the camera reads.
  Stage& stage() { return stage_; }

 private:
  RigScanner(const RigScannerOptions& options, double degrees);
  Expected<void> plug_board();
  void keep(double goal);
  void write_down(std::string_view text, std::chrono::system_clock::time_point submitted);
  void turned(int turns);
  Exposed expose(const Exposure& exposure, const SensorRegion& region);
  Delivery delivery(int turns);

  const RigScannerOptions options_;
  const double degrees_;  // the table's angle when the board's position is 0
  // Only the camera's thread uses this member and the next two.
  Renderer renderer_;
  std::uint64_t frames_ = 0;
  int missed_at_ = -1;  // number of completed motions at the last missed trigger
  std::ofstream commands_;
  Stage stage_;
  std::unique_ptr<GigeCamera> camera_;
  UsbBoard board_;
  Cable camera_cable_, board_cable_;
  // Stalls the motor from a thread of its own, because the board's callbacks must not call the
  // board.
  std::jthread brake_;
};

}  // namespace vitrine::acquisition::rig
