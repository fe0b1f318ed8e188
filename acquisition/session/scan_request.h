// SPDX-License-Identifier: Apache-2.0
// What a scan is to be, and what is written down about it when it starts.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "acquisition/device/camera.h"
#include "acquisition/session/processing.h"

namespace vitrine {

inline constexpr int kLeastSteps = 8, kMostSteps = 36'000;
inline constexpr int kMostCalibration = 1'000'000'000;       // number
inline constexpr double kMostExposure = 1e6;                 // microseconds
inline constexpr double kMostAngle = 90, kMostHole = 1'000;  // degrees, mm

// In the order of SamplingMethod and StripeMethod.
inline constexpr std::array<std::string_view, 3> kSamplingNames = {"equidistant", "paper",
                                                                   "adaptive"};
inline constexpr std::array<std::string_view, 3> kStripeNames = {"derivative-of-gaussian",
                                                                 "centre-of-mass", "blais-rioux"};

inline constexpr std::array kSamplingLengths = {5, 10, 15, 20};  // points

struct ScanRequest {
  int steps = 720;                    // of one turn of the table, kLeastSteps to kMostSteps
  std::optional<double> exposure_us;  // nothing: the scanner's
  int calibration = 0;                // its number; 0: the newest of that camera and region
  bool keep_frames = false;           // for other ways to find the stripe afterwards
  Processing processing;
};

Expected<void> check(const ScanRequest& request);

// All that another process needs to go on with the scan. Written once, never changed.
struct ScanRecord {
  ScanRequest request;
  std::string created;             // 2026-11-23T08:00:00Z
  std::string scanner;             // its name
  std::string camera;              // serial
  CameraSettings settings;         // as used
  std::string board;               // dialect and serial
  int calibration = 0;             // number
  std::string calibration_digest;  // digest_of(); empty: not known
};

inline double angle_of(const ScanRequest& request, int step) {
  return 360.0 * step / request.steps;
}

// As scan.json holds it. `place` names the file in errors.
std::string to_json_text(const ScanRecord& record);
Expected<ScanRecord> scan_record_of(std::string_view text, const std::string& place);

}  // namespace vitrine
