// SPDX-License-Identifier: Apache-2.0
// The parameters of a scan, and the record that is written when it starts.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "acquisition/device/camera.h"
#include "acquisition/session/processing.h"

namespace vitrine::acquisition {

inline constexpr int kLeastSteps = 8, kMostSteps = 36'000;
inline constexpr int kMostCalibration = 1'000'000'000;       // largest number of a calibration
inline constexpr double kMostExposure = 1e6;                 // in microseconds
inline constexpr double kMostAngle = 90, kMostHole = 1'000;  // in degrees and in mm

// Names of the values of SamplingMethod and StripeMethod, in the order of the enumerations.
inline constexpr std::array<std::string_view, 3> kSamplingNames = {"equidistant", "paper",
                                                                   "adaptive"};
inline constexpr std::array<std::string_view, 3> kStripeNames = {"derivative-of-gaussian",
                                                                 "centre-of-mass", "blais-rioux"};

inline constexpr std::array kSamplingLengths = {5, 10, 15, 20};  // window lengths, in points

struct ScanRequest {
  int steps = 720;                    // steps in one revolution, kLeastSteps to kMostSteps
  std::optional<double> exposure_us;  // nullopt: the scanner's default
  // Number of the calibration. 0: the newest for that camera and region.
  int calibration = 0;
  // Whether to keep the pictures, so that the stripe can be found again with other methods.
  bool keeps_frames = false;
  Processing processing;
};

Expected<void> check(const ScanRequest& request);

// The data that another process needs to resume the scan. It is written once and never changed.
struct ScanRecord {
  ScanRequest request;
  std::string created;             // UTC, such as 2026-11-23T08:00:00Z
  std::string scanner;             // name of the scanner
  std::string camera;              // the camera's serial number
  CameraSettings settings;         // the settings that the scan used
  std::string board;               // dialect and serial number of the board
  int calibration = 0;             // number of the calibration
  std::string calibration_digest;  // digest_of() the calibration; empty if unknown
};

inline double angle_of(const ScanRequest& request, int step) {
  return 360.0 * step / request.steps;
}

// Write and read scan.json. Errors call the file `place`.
std::string to_json_text(const ScanRecord& record);
Expected<ScanRecord> scan_record_of(std::string_view text, const std::string& place);

}  // namespace vitrine::acquisition
