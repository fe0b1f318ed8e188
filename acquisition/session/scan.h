// SPDX-License-Identifier: Apache-2.0
// A scan that any thread can start, watch, pause, resume and cancel. It is stored in a folder
// (scan_folder.h). If this process ends, a later process can resume the scan. The mesh is the same
// as without the interruption.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "acquisition/session/scan_run.h"
#include "acquisition/surface/surface_of.h"

namespace vitrine::acquisition {

struct ScanSettings {
  RetryLimits retries;
  std::function<double()> seconds;  // a monotonic clock in seconds; empty: the system's clock
};

class Scan : private ScanWatch {
 public:
  // Creates a new, idle scan. Fails if `folder` cannot be created or already holds a scan, or if
  // the request is invalid.
  static Expected<std::unique_ptr<Scan>> create(Scanner scanner, const ScanRequest& request,
                                                const std::filesystem::path& folder,
                                                ScanSettings settings = {});
  // Opens the scan in `folder`. A scan stored as done, cancelled or failed keeps that state. Any
  // other scan is paused.
  static Expected<std::unique_ptr<Scan>> reopen(Scanner scanner,
                                                const std::filesystem::path& folder,
                                                ScanSettings settings = {});
  ~Scan() override;  // pauses a running scan

  // resume() starts an idle scan, continues a paused or failed scan, or makes the mesh of a
  // finished scan again. resume(), pause() and cancel() do not wait for the scan. They fail with
  // kState if the scan's state does not allow the call, and with kIo if no thread can be started.
  Expected<void> resume();
  Expected<void> pause();   // takes effect after the current step
  Expected<void> cancel();  // measured steps stay in the folder

  // Switches laser and motor off at once. The scan fails and can be resumed.
  void emergency_stop() noexcept;

  ScanStatus status() const;
  // Waits until the scan is not checking, scanning or meshing, but at most for the time `at_most`.
  // Returns the status.
  ScanStatus wait(std::chrono::milliseconds at_most) const;
  const LivePreview& preview() const { return preview_; }
  const ScanFolder& folder() const { return folder_; }

  // Returns the mesh. Returns null until the scan is done, and also after resume() until the scan
  // is done again.
  std::shared_ptr<const ScannedSurface> surface() const;

 private:
  enum class RequestedAction { kRun, kPause, kCancel };

  Scan(Scanner scanner, const ScanRequest& request, ScanFolder folder, ScanSettings settings);

  bool is_interrupted() const override;
  void sleep(std::chrono::milliseconds at_most) override;
  void checks_passed() override;
  void step_done(int steps_done, const StripeCount& so_far) override;
  void waits_for(const Error& lost) override;

  void work();
  Expected<std::shared_ptr<const ScannedSurface>> run_and_mesh();
  void enter(ScanState state);  // the caller must hold mutex_
  double now() const;           // returns the time in seconds

  const Scanner scanner_;
  const ScanRequest request_;
  const ScanFolder folder_;
  const ScanSettings settings_;
  LivePreview preview_;
  EmergencyStop stop_;

  mutable std::mutex mutex_;  // guards the members below
  mutable std::condition_variable changed_;
  ScanStatus status_;
  RequestedAction requested_ = RequestedAction::kRun;
  // Time, in seconds, at the start of this run's first step.
  double started_ = 0;
  int steps_before_ = 0;  // number of steps done before this run
  std::shared_ptr<const ScannedSurface> surface_;

  std::jthread thread_;
};

}  // namespace vitrine::acquisition
