// SPDX-License-Identifier: Apache-2.0
// The rig as a whole: what stands before the camera, the camera, and what goes wrong.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "acquisition/rig/cable.h"
#include "acquisition/rig/fault.h"
#include "acquisition/rig/gige_camera.h"
#include "acquisition/rig/renderer.h"
#include "acquisition/rig/stage.h"

namespace vitrine::rig {

struct ScannerOptions {
  const Subject* object = nullptr;  // outlives the scanner; null: an empty table
  Realism realism;
  std::vector<Fault> faults;
  std::string camera_address = "127.0.0.1";
};

// The same for the same seed: a rig that is started anew is the rig it was.
std::string camera_serial(std::uint64_t seed);

class Scanner {
 public:
  static Expected<std::unique_ptr<Scanner>> start(const ScannerOptions& options);

  // The board turns its table and switches its laser.
  Stage& stage() { return stage_; }

 private:
  explicit Scanner(const ScannerOptions& options);
  void turned(int turns);
  Exposed expose(const Exposure& exposure, const SensorRegion& region);
  Delivery delivery(int turns);

  const ScannerOptions options_;
  Renderer renderer_;  // of the camera's thread alone, as are the next two
  std::uint64_t frames_ = 0;
  int missed_at_ = -1;  // motions, when a trigger was missed last
  Stage stage_;
  std::unique_ptr<GigeCamera> camera_;
  Cable camera_cable_;
};

}  // namespace vitrine::rig
