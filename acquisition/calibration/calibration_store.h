// SPDX-License-Identifier: Apache-2.0
// Calibrations as a folder of files 0001.json, 0002.json, … that are never changed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "acquisition/calibration/calibration.h"
#include "codec/core/expected.h"

namespace vitrine {

class CalibrationStore {
 public:
  explicit CalibrationStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // Writes it under the next number and returns it with that; creates the folder. Two writers at a
  // time get two numbers. Fails with kIo, or with kBadInput where it could not be read again.
  Expected<Calibration> add(Calibration calibration) const;

  // Fails with kIo where there is none of that number, kBadInput where the file is damaged.
  Expected<Calibration> load(int number) const;

  // Ascending; none where there is no folder.
  Expected<std::vector<int>> numbers() const;

  // The newest whole one of that camera and region. Where there is none it fails: kBadInput naming
  // a damaged file, or kState telling whether camera or region differ.
  Expected<Calibration> for_camera(const std::string& serial, const SensorRegion& region) const;

 private:
  std::filesystem::path file_of(int number) const;

  std::filesystem::path folder_;
};

}  // namespace vitrine
