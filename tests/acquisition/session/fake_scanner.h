// SPDX-License-Identifier: Apache-2.0
// A scanner in memory: a board that turns a fluted column, and a camera that sees the laser on it
// through a plane map that is known. What goes wrong is told by a function.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "acquisition/calibration/calibration.h"
#include "acquisition/session/scanner.h"

namespace vitrine::test {

inline constexpr int kFakeWidth = 160, kFakeHeight = 24;  // pixels
inline constexpr double kFakePixel = 0.25;                // mm
inline constexpr int kFakeOtherRow = 12;  // from here on kTwoSurfaces shows a surface behind
inline constexpr const char* kFakeSerial = "fake-1";

enum class FakeObject {
  kColumn,
  kNothing,
  kEmptyTable,
  kSaturated,
  kTwoStripes,
  kTwoSurfaces,
  kOverExposed
};

// What the devices share. `fault` is asked at each call of a device ("open camera", "capture",
// "turn", "laser on", …) with how often it has been made, from 1; true: the device is lost.
struct FakeWorld {
  std::function<bool(const std::string& call, int count)> fault;
  std::function<void(const std::string& call, int count)> meanwhile;  // another thread's doing
  // Whether that capture delivers the frame before once more.
  std::function<bool(int count)> repeats;
  std::string serial = kFakeSerial;
  FakeObject object = FakeObject::kColumn;
  bool is_ideal = false;          // the camera has no noise
  bool forgets_position = false;  // a board that has been restarted when it is opened anew

  mutable std::mutex mutex;  // of what follows
  std::map<std::string, int> calls;
  double degrees = 0;
  bool position_known = true;
  bool laser = false, motor = false, stopped = false;
  int open_boards = 0, open_cameras = 0;
};

Scanner fake_scanner(FakeWorld& world, const std::filesystem::path& calibrations);

double fake_radius(double degrees);  // of the column, mm, where the table shows it at that angle

// Of the fake camera, not numbered yet.
Calibration fake_calibration();

}  // namespace vitrine::test
