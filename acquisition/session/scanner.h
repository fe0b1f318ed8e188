// SPDX-License-Identifier: Apache-2.0
// The parts of a scanner that a scan needs: how to open its devices, how to set its camera, and the
// folder of its calibrations.
#pragma once

#include <filesystem>
#include <string>

#include "acquisition/session/live_scanner.h"

namespace vitrine::acquisition {

struct Scanner {
  std::string name;
  ScannerDevices devices;
  CameraSettings settings;
  std::filesystem::path calibrations;  // folder of the calibrations
};

}  // namespace vitrine::acquisition
