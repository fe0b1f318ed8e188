// SPDX-License-Identifier: Apache-2.0
// The ScannerBackend for real devices, and for the devices of the simulated rig.
#pragma once

#include <mutex>

#include "acquisition/calibration/calibrate.h"
#include "acquisition/session/emergency_stop.h"
#include "acquisition/session/scan.h"
#include "acquisition/session/scanner_config.h"
#include "server/jobs/scanner_backend.h"

namespace vitrine::server {

class SessionBackend final : public ScannerBackend {
 public:
  SessionBackend(acquisition::ScannerConfig config, acquisition::Scanner scanner)
      : config_(std::move(config)), scanner_(std::move(scanner)) {}
  ~SessionBackend() override { close(); }

  Expected<ScannerIdentity> identify() override;
  Expected<void> jog(double degrees) override;
  Expected<void> laser(bool on) override;
  Expected<void> keep_laser() override;
  Expected<acquisition::Frame> picture() override;
  Expected<std::optional<TriangleMesh>> scan(const ScanOrder& order,
                                             const std::filesystem::path& folder,
                                             ScanListener& listener) override;
  Expected<int> calibrate(const CalibrationOrder& order, CalibrationListener& listener) override;
  void close() override;

  const std::string& name() const override { return config_.name; }
  acquisition::BoardPower power() const override { return scanner_.power->read(); }
  void emergency_stop() noexcept override;
  std::uint64_t stops() const noexcept override { return stop_.presses(); }
  void allow(std::uint64_t stops) noexcept override { stop_.release(stops); }
  Expected<TriangleMesh> rebuild_mesh(const ScanOrder& order,
                                      const std::filesystem::path& folder) override;
  Expected<std::shared_ptr<const ScanView>> view(const std::filesystem::path& folder) override;
  Expected<std::vector<CalibrationSummary>> calibrations() override;
  Expected<std::optional<std::string>> calibration_report(int number) override;
  Expected<std::optional<std::string>> residual_plot(int number) override;

 private:
  Expected<void> open();
  Expected<void> open_board();
  Expected<void> open_camera();
  // Returns `result`; closes the devices if it is an error.
  template <class T>
  Expected<T> closed_on_error(Expected<T> result);
  Expected<std::shared_ptr<acquisition::Scan>> open_scan(const ScanOrder& order,
                                                         const std::filesystem::path& folder);
  void drive(const std::shared_ptr<acquisition::Scan>& scan);
  Expected<acquisition::CalibrationInput> picture_at_rig(CalibrationListener& listener);
  Expected<acquisition::CalibrationInput> picture_by_hand(int poses, CalibrationListener& listener);

  const acquisition::ScannerConfig config_;
  const acquisition::Scanner scanner_;
  acquisition::EmergencyStop stop_;
  std::unique_ptr<acquisition::Camera> camera_;  // kept open between jobs
  std::unique_ptr<acquisition::Board> board_;

  std::mutex mutex_;                         // guards the members below
  std::shared_ptr<acquisition::Scan> scan_;  // the running scan, or null
};

}  // namespace vitrine::server
