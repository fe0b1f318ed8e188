// SPDX-License-Identifier: Apache-2.0
// A simulated scanner, without devices. The board turns a fluted column. The camera sees the
// laser's stripe on the column through a known plane map. A function injects faults.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "acquisition/calibration/calibration.h"
#include "acquisition/session/scanner.h"
#include "support/product_names.h"

namespace vitrine::test {

inline constexpr int kFakeWidth = 160, kFakeHeight = 24;  // size of a picture, in pixels
inline constexpr double kFakePixel = 0.25;                // width of a pixel in mm
// First row in which the object kTwoSurfaces shows a second surface behind the first.
inline constexpr int kFakeOtherRow = 12;
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

// The state that the fake devices share. Each call of a device ("open camera", "capture", "turn",
// "laser on", …) calls `fault` with its name and the number of such calls so far. If `fault`
// returns true, the device is lost.
struct FakeWorld {
  std::function<bool(const std::string& call, int count)> fault;
  std::function<void(const std::string& call, int count)>
      meanwhile;  // called at each call of a device, to simulate another thread
  // Returns whether capture number `count` must return the preceding frame again.
  std::function<bool(int count)> repeats;
  std::string serial = kFakeSerial;
  FakeObject object = FakeObject::kColumn;
  bool is_ideal = false;          // the camera has no noise
  bool forgets_position = false;  // the board does not know its position after it is reopened

  mutable std::mutex mutex;  // guards the members below
  std::map<std::string, int> calls;
  double degrees = 0;
  bool position_known = true;
  bool laser = false, motor = false, stopped = false;
  int open_boards = 0, open_cameras = 0;
};

Scanner fake_scanner(FakeWorld& world, const std::filesystem::path& calibrations);

// Returns the column's radius, in mm, at the table angle `degrees`.
double fake_radius(double degrees);

// Returns the calibration of the fake camera. The caller must set the calibration's number.
Calibration fake_calibration();

}  // namespace vitrine::test
