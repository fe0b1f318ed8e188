// SPDX-License-Identifier: Apache-2.0
// A scan as something that is started, watched, paused, resumed and cancelled from any thread. It
// lives in a folder (scan_folder.h): whatever ends this process, a later one goes on with it, and
// the mesh is the same as if nothing had happened.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "acquisition/session/scan_run.h"
#include "acquisition/surface/surface_of.h"

namespace vitrine {

struct ScanSettings {
  Patience patience;
  std::function<double()> seconds;  // a clock that only grows; empty: the computer's
};

class Scan : private ScanWatch {
 public:
  // A new scan, idle. Fails where `folder` cannot be made or holds a scan, or the request is wrong.
  static Expected<std::unique_ptr<Scan>> create(Scanner scanner, const ScanRequest& request,
                                                const std::filesystem::path& folder,
                                                ScanSettings settings = {});
  // The scan in `folder`: paused, or done, cancelled or failed as it was.
  static Expected<std::unique_ptr<Scan>> reopen(Scanner scanner,
                                                const std::filesystem::path& folder,
                                                ScanSettings settings = {});
  ~Scan() override;  // pauses a scan that runs

  // Starts an idle scan, goes on with one that is paused or failed, meshes a done one anew: each
  // returns at once. kState where the scan's state does not allow it, kIo where no thread can be
  // had.
  Expected<void> resume();
  Expected<void> pause();   // takes effect after the present step
  Expected<void> cancel();  // what has been measured stays in the folder

  // Laser and motor off at once; the scan fails and can be resumed.
  void emergency_stop() noexcept;

  ScanStatus status() const;
  // Waits until it neither checks, scans nor meshes, or for `at_most`.
  ScanStatus wait(std::chrono::milliseconds at_most) const;
  const LivePreview& preview() const { return preview_; }
  const ScanFolder& folder() const { return folder_; }

  // Once it is done and until it is resumed; null before.
  std::shared_ptr<const ScannedSurface> surface() const;

 private:
  enum class Wish { kRun, kPause, kCancel };

  Scan(Scanner scanner, const ScanRequest& request, ScanFolder folder, ScanSettings settings);

  bool is_interrupted() const override;
  void sleep(std::chrono::milliseconds at_most) override;
  void checks_passed() override;
  void step_done(int steps_done, const StripeCount& so_far) override;
  void waits_for(const Error& lost) override;

  void work();
  Expected<std::shared_ptr<const ScannedSurface>> run_and_mesh();
  void enter(ScanState state);  // under mutex_
  double now() const;           // seconds

  const Scanner scanner_;
  const ScanRequest request_;
  const ScanFolder folder_;
  const ScanSettings settings_;
  LivePreview preview_;
  EmergencyStop stop_;

  mutable std::mutex mutex_;  // of what follows
  mutable std::condition_variable changed_;
  ScanStatus status_;
  Wish wish_ = Wish::kRun;
  double started_ = 0;    // seconds, when the first step of this run began
  int steps_before_ = 0;  // this run
  std::shared_ptr<const ScannedSurface> surface_;

  std::jthread thread_;
};

}  // namespace vitrine
