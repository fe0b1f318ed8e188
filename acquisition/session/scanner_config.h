// SPDX-License-Identifier: Apache-2.0
// rig.json: one scanner, written by an operator, or by vitrine-rig for the one that it simulates.
#pragma once

#include <filesystem>
#include <string>

#include "acquisition/calibration/target.h"
#include "acquisition/device/board.h"
#include "acquisition/device/camera.h"

namespace vitrine {

struct ScannerConfig {
  std::string name;
  CameraSelector camera;
  BoardSelector board;
  CameraSettings settings;
  Target target;
  int steps = 720;                     // of a scan that does not say
  std::filesystem::path calibrations;  // folder
  std::filesystem::path rig;           // socket of the simulated rig; empty: an operator places
                                       // the target by hand
};

// Paths are relative to the folder of the file. Fails (kIo, kBadInput) with file, key and what is
// expected there.
Expected<ScannerConfig> read_scanner_config(const std::filesystem::path& path);
Expected<ScannerConfig> parse_scanner_config(std::string_view text,
                                             const std::filesystem::path& path);

}  // namespace vitrine
