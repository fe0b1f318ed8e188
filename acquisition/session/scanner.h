// SPDX-License-Identifier: Apache-2.0
// A scanner as a scan needs it: how to open its devices, how to set its camera, and where its
// calibrations are.
#pragma once

#include <filesystem>
#include <string>

#include "acquisition/session/live_scanner.h"

namespace vitrine {

struct Scanner {
  std::string name;
  ScannerDevices devices;
  CameraSettings settings;
  std::filesystem::path calibrations;  // folder
};

}  // namespace vitrine
