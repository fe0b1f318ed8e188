// SPDX-License-Identifier: Apache-2.0
// The rig as a whole: what stands before the camera, the camera, and what goes wrong.
#pragma once

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
#include "acquisition/rig/renderer.h"
#include "acquisition/rig/stage.h"
#include "acquisition/rig/usb_board.h"

namespace vitrine::rig {

struct ScannerOptions {
  const Subject* object = nullptr;  // outlives the scanner; null: nothing shows light
  Realism realism;
  std::vector<Fault> faults;
  std::string camera_address = "127.0.0.1";
  bool fabscan = false;            // the board, instead of Horus
  double degrees_per_second = 0;   // of the table; 0: it is there at once
  std::filesystem::path table;     // keeps where it stands; empty: it stands at 0 degrees at first
  std::filesystem::path commands;  // is told all that the board is; empty: nobody is
};

// The same for the same seed: a rig that is started anew is the rig it was.
std::string camera_serial(std::uint64_t seed);
UsbBoardSettings board_settings(std::uint64_t seed, bool fabscan);

class Scanner {
 public:
  static Expected<std::unique_ptr<Scanner>> start(const ScannerOptions& options);

  // Its board turns the table and switches the laser.
  Stage& stage() { return stage_; }

 private:
  Scanner(const ScannerOptions& options, double degrees);
  Expected<void> plug_board();
  void keep(double goal);
  void write_down(std::string_view text);
  void turned(int turns);
  Exposed expose(const Exposure& exposure, const SensorRegion& region);
  Delivery delivery(int turns);

  const ScannerOptions options_;
  const double degrees_;  // of the table, where the board counts from 0
  Renderer renderer_;     // of the camera's thread alone, as are the next two
  std::uint64_t frames_ = 0;
  int missed_at_ = -1;  // motions, when a trigger was missed last
  std::ofstream commands_;
  Stage stage_;
  std::unique_ptr<GigeCamera> camera_;
  UsbBoard board_;
  Cable camera_cable_, board_cable_;
  std::jthread brake_;  // a stall comes from elsewhere, too: the board's thread may not call it
};

}  // namespace vitrine::rig
