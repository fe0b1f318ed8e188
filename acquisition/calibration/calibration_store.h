// SPDX-License-Identifier: Apache-2.0
// Stores calibrations in a folder as files 0001.json, 0002.json, … that never change.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "acquisition/calibration/calibration.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition {

class CalibrationStore {
 public:
  explicit CalibrationStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // Writes the calibration under the next free number and returns it with that number. Creates the
  // folder if needed. Concurrent writers get different numbers. Fails with kIo, or with kBadInput
  // if the written file could not be read back.
  Expected<Calibration> add(Calibration calibration) const;

  // Reads a stored calibration. Fails with kIo if no calibration has that number, and with
  // kBadInput if the file is damaged.
  Expected<Calibration> load(int number) const;

  // Returns the numbers of all calibrations in ascending order. Empty if the folder does not exist.
  Expected<std::vector<int>> numbers() const;

  // Returns the newest undamaged calibration of that camera and region. If there is none, fails
  // with kBadInput if a file is damaged, and names the file. Otherwise fails with kState and says
  // whether camera or region differs.
  Expected<Calibration> for_camera(const std::string& serial, const SensorRegion& region) const;

 private:
  std::filesystem::path file_of(int number) const;

  std::filesystem::path folder_;
};

}  // namespace vitrine::acquisition
