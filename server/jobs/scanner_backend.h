// SPDX-License-Identifier: Apache-2.0
// The interface through which jobs use a scanner: its devices, scans and calibrations.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/device/board.h"
#include "acquisition/device/camera.h"
#include "acquisition/frame/frame.h"
#include "codec/mesh/triangle_mesh.h"
#include "server/catalogue/jobs.h"
#include "server/jobs/scan_order.h"

namespace vitrine::server {

struct ScannerIdentity {
  acquisition::CameraIdentity camera;
  acquisition::BoardIdentity board;
  // Number of the newest calibration that fits the camera; nullopt if no calibration fits it.
  std::optional<int> calibration;
};

struct ScanProgress {
  const char* stage = "scanning";  // "scanning" or "meshing"
  int step = 0;                    // number of steps done
  double progress = 0;             // progress of both stages together, 0..1
  std::optional<double> eta;       // remaining seconds
  int calibration = 0;             // number of the calibration; 0: not known yet
  std::optional<ScannedRows> rows;
  std::string note;  // why the scan waits, for example for a camera; usually empty
};

// A view of a scan while it runs and after it has ended. Thread-safe; calls return quickly.
class ScanView {
 public:
  virtual ~ScanView() = default;

  // Returns the latest picture with the laser on, or null if there is none yet.
  virtual std::shared_ptr<const acquisition::Frame> frame() const = 0;
  // Returns the points of the latest profile in mm: rho, the distance from the table's axis, and z,
  // the height.
  virtual std::vector<std::array<double, 2>> profile() const = 0;
  virtual ScanProgress progress() const = 0;
  virtual std::size_t points() const = 0;
  // Returns the points from number `first` on, in mm, z upwards, in the order of measurement.
  // Existing points never change.
  virtual std::vector<std::array<float, 3>> points_from(std::size_t first) const = 0;
};

// Receives the progress of a scan, and can interrupt it. The thread that scans calls the functions.
class ScanListener {
 public:
  virtual ~ScanListener() = default;

  virtual void begins(std::shared_ptr<const ScanView> view) = 0;
  virtual void report(const ScanProgress& progress) = 0;
  virtual bool is_interrupted() const = 0;
  virtual bool is_cancelled() const = 0;  // whether the interruption is final
};

struct CalibrationProgress {
  std::string stage = "calibrating";  // "calibrating" or an instruction to the operator
  double progress = 0;                // 0..1
  std::string note;                   // interim result
};

// Receives the progress of a calibration, and can interrupt it. The thread that calibrates calls
// the functions.
class CalibrationListener {
 public:
  virtual ~CalibrationListener() = default;

  virtual void report(const CalibrationProgress& progress) = 0;
  // Waits until the operator has followed the instruction in `stage`. Returns false if interrupted.
  virtual bool await_operator(const CalibrationProgress& progress) = 0;
  virtual bool is_interrupted() const = 0;
};

struct CalibrationSummary {
  int number = 0;
  std::string problem;  // why the calibration is unusable; empty if it is usable
  std::string created, camera;
  acquisition::SensorRegion region;
  double rms = 0, p95 = 0, max = 0;  // residuals in mm, measured on held-out poses
  double coverage = 0;               // share of the picture that the target covered, 0..1
};

// A scanner. Only one thread at a time may call the functions from identify() to close(). Any
// thread may call the functions that are declared after close().
class ScannerBackend {
 public:
  virtual ~ScannerBackend() = default;

  // The functions from here to calibrate() close the devices on an error. All except keep_laser()
  // first open the devices that they need.
  virtual Expected<ScannerIdentity> identify() = 0;
  virtual Expected<void> jog(double degrees) = 0;  // turns the table by an angle
  virtual Expected<void> laser(bool on) = 0;
  // Resets the timer of the board's watchdog, so that the laser stays on. Fails without switching
  // anything on if the board is not open.
  virtual Expected<void> keep_laser() = 0;
  // Takes a picture. Uses only the camera, so this also works after an emergency stop.
  virtual Expected<acquisition::Frame> picture() = 0;

  // Measures the steps that `folder` does not contain yet, and meshes all steps. Returns nullopt if
  // interrupted; a later call continues. Laser and motor are off on return.
  virtual Expected<std::optional<TriangleMesh>> scan(const ScanOrder& order,
                                                     const std::filesystem::path& folder,
                                                     ScanListener& listener) = 0;
  // Calibrates the scanner and returns the number of the new calibration. The operator places the
  // target; the simulated rig places it by itself.
  virtual Expected<int> calibrate(const CalibrationOrder& order, CalibrationListener& listener) = 0;

  virtual void close() = 0;

  virtual const std::string& name() const = 0;

  // Returns the state of laser and motor without using a device.
  virtual acquisition::BoardPower power() const = 0;

  // Turns laser and motor off at once. The board stays unused until allow() is called.
  virtual void emergency_stop() noexcept = 0;
  virtual std::uint64_t stops() const noexcept = 0;  // number of emergency stops so far
  // Allows commands again, unless more than `stops` emergency stops have occurred. A stop that the
  // client does not know about therefore stays in force.
  virtual void allow(std::uint64_t stops) noexcept = 0;

  // Rebuilds the mesh of a stored scan that no job uses.
  virtual Expected<TriangleMesh> rebuild_mesh(const ScanOrder& order,
                                              const std::filesystem::path& folder) = 0;
  virtual Expected<std::shared_ptr<const ScanView>> view(const std::filesystem::path& folder) = 0;

  // Returns all calibrations, the newest first.
  virtual Expected<std::vector<CalibrationSummary>> calibrations() = 0;
  // These functions return the report as JSON and the plot as SVG, or nullopt if no calibration has
  // this number.
  virtual Expected<std::optional<std::string>> calibration_report(int number) = 0;
  virtual Expected<std::optional<std::string>> residual_plot(int number) = 0;
};

}  // namespace vitrine::server
