// SPDX-License-Identifier: Apache-2.0
// The configuration of one scanner, as in `rig.json`. An operator writes `rig.json` by hand;
// vitrine-rig writes one for its simulated scanner.
#pragma once

#include <filesystem>
#include <string>

#include "acquisition/calibration/target.h"
#include "acquisition/device/board.h"
#include "acquisition/device/camera.h"

namespace vitrine::acquisition {

struct ScannerConfig {
  std::string name;
  CameraSelector camera;
  BoardSelector board;
  CameraSettings settings;
  CharucoTarget target;
  int steps = 720;                     // default number of steps of a scan
  std::filesystem::path calibrations;  // folder of the calibrations
  // Socket of the simulated rig. Empty: a human operator places the target.
  std::filesystem::path rig;
};

// Both functions read the configuration. Relative paths are relative to the file's folder. Both
// fail with kIo or kBadInput; the error names the file, the key and the expected value.
Expected<ScannerConfig> read_scanner_config(const std::filesystem::path& path);
Expected<ScannerConfig> parse_scanner_config(std::string_view text,
                                             const std::filesystem::path& path);

}  // namespace vitrine::acquisition
