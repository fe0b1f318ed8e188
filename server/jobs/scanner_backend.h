// SPDX-License-Identifier: Apache-2.0
// One scanner as jobs use it: devices, scans and calibrations.
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

namespace vitrine {

struct ScannerIdentity {
  CameraIdentity camera;
  BoardIdentity board;
  std::optional<int> calibration;  // the newest that fits the camera; nothing: there is none
};

struct ScanTold {
  const char* stage = "scanning";  // or "meshing"
  int step = 0;                    // done so far
  double progress = 0;             // 0..1 of the stages above
  std::optional<double> eta;       // seconds
  int calibration = 0;             // its number; 0: not known yet
  std::optional<ScannedRows> rows;
  std::string note;  // what it waits for: a camera that is gone; mostly empty
};

// What is to be seen of a scan while it grows and afterwards. Thread-safe; nobody waits for long.
class ScanView {
 public:
  virtual ~ScanView() = default;

  virtual std::shared_ptr<const Frame> frame() const = 0;  // the latest, laser on; may be null
  virtual std::vector<std::array<double, 2>> profile() const = 0;  // the latest: rho, z in mm
  virtual ScanTold told() const = 0;                               // how far it is
  virtual std::size_t points() const = 0;
  // mm, z upwards, in the order in which they came, from number `first` on. Grows only.
  virtual std::vector<std::array<float, 3>> points_from(std::size_t first) const = 0;
};

// Who is told about a scan, from the thread that does it, and may put it aside.
class ScanListener {
 public:
  virtual ~ScanListener() = default;

  virtual void begins(std::shared_ptr<const ScanView> view) = 0;
  virtual void told(const ScanTold& told) = 0;
  virtual bool is_interrupted() const = 0;
  virtual bool is_cancelled() const = 0;  // is_interrupted(), and not to be gone on with
};

struct CalibrationTold {
  std::string stage = "calibrating";  // or what somebody is asked to do
  double progress = 0;                // 0..1
  std::string note;                   // what has come of it so far
};

// Who is told about a calibration, from the thread that does it, and may end it.
class CalibrationListener {
 public:
  virtual ~CalibrationListener() = default;

  virtual void told(const CalibrationTold& told) = 0;
  // Until somebody has done what the stage says; false where it is interrupted.
  virtual bool await_operator(const CalibrationTold& told) = 0;
  virtual bool is_interrupted() const = 0;
};

struct CalibrationSummary {
  int number = 0;
  std::string problem;  // why it cannot be used, and there is nothing below; mostly empty
  std::string created, camera;
  SensorRegion region;
  double rms = 0, p95 = 0, max = 0;  // mm, over held-out poses
  double coverage = 0;               // share of the picture
};

// Everything up to `close` is called by one thread, the rest by any.
class ScannerBackend {
 public:
  virtual ~ScannerBackend() = default;

  // These open the devices where they are closed. An error closes them.
  virtual Expected<ScannerIdentity> identify() = 0;
  virtual Expected<void> jog(double degrees) = 0;  // from where the table stands
  virtual Expected<void> laser(bool on) = 0;
  // By the camera alone: also after an emergency stop.
  virtual Expected<Frame> picture() = 0;

  // Scans what `folder` does not hold yet, and meshes all of it; nothing where it was interrupted:
  // a later call goes on. Laser and motor are off on return.
  virtual Expected<std::optional<TriangleMesh>> scan(const ScanOrder& order,
                                                     const std::filesystem::path& folder,
                                                     ScanListener& listener) = 0;
  // The new calibration's number. Whoever is there places the target; the simulated rig does that
  // itself, in poses of its own.
  virtual Expected<int> calibrate(const CalibrationOrder& order, CalibrationListener& listener) = 0;

  virtual void close() = 0;

  virtual const std::string& name() const = 0;

  // Laser and motor off at once, and the board is not used before allow().
  virtual void emergency_stop() noexcept = 0;
  virtual std::uint64_t stops() const noexcept = 0;  // how many so far
  // Takes back the first `stops`: a later one holds.
  virtual void allow(std::uint64_t stops) noexcept = 0;

  // Of a scan that nobody works on.
  virtual Expected<TriangleMesh> mesh_anew(const ScanOrder& order,
                                           const std::filesystem::path& folder) = 0;
  virtual Expected<std::shared_ptr<const ScanView>> view(const std::filesystem::path& folder) = 0;

  virtual Expected<std::vector<CalibrationSummary>> calibrations() = 0;  // newest first
  // JSON and SVG; nothing where there is no such number.
  virtual Expected<std::optional<std::string>> calibration_report(int number) = 0;
  virtual Expected<std::optional<std::string>> residual_plot(int number) = 0;
};

}  // namespace vitrine
