// SPDX-License-Identifier: Apache-2.0
// The parts of a scanner that a scan needs: functions that open the devices, the camera's settings,
// and the folder of the calibrations.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "acquisition/device/power_record.h"
#include "acquisition/session/live_scanner.h"

namespace vitrine::acquisition {

struct Scanner {
  std::string name;
  ScannerDevices devices;
  CameraSettings settings;
  std::filesystem::path calibrations;  // folder of the calibrations
  // The state of laser and motor of the board that `devices` opens.
  std::shared_ptr<PowerRecord> power = std::make_shared<PowerRecord>();
};

}  // namespace vitrine::acquisition
