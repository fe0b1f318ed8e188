// SPDX-License-Identifier: Apache-2.0
// A scanner outside of its jobs: its state and an operator's manual commands.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <optional>

#include "server/jobs/job_queue.h"
#include "server/jobs/scanner_backend.h"

namespace vitrine::server {

enum class ScannerState : std::uint8_t { kIdle, kBusy, kUnreachable };

struct ScannerStatus {
  std::string name;
  ScannerState state = ScannerState::kIdle;
  std::optional<ScannerIdentity> identity;  // as last seen; nullopt if never seen
  std::optional<ScanId> scan;               // the running or paused scan
  std::string problem;                      // why the scanner is unreachable
};

// Thread-safe. Commands fail with kState while a job uses the scanner, and with the errors of the
// devices.
class ScannerStation {
 public:
  // `backend` and `jobs` must outlive the station. Devices without a command for `idle_timeout` are
  // closed, so that other programs can use them.
  ScannerStation(ScannerBackend& backend, JobQueue& jobs, std::chrono::milliseconds idle_timeout);

  // Starts the first look for the scanner. Call it once. status() waits briefly for the result.
  void look_for_it();

  ScannerBackend& backend() { return backend_; }
  const std::string& name() const { return backend_.name(); }

  // Returns the state without using a device. If the scanner is unreachable, starts another look
  // for it.
  ScannerStatus status();

  Expected<void> jog(double degrees);
  Expected<void> laser(bool on);
  // Takes a picture. Works during a paused scan, and does not undo an emergency stop.
  Expected<acquisition::Frame> picture();

  // Turns laser and motor off at once. Pauses a running scan and ends a running calibration.
  void stop();

  // Looks for the scanner: identifies its devices and closes them. Runs on the scanner's executor.
  void look();
  // Posts a task to the scanner's executor that closes the devices.
  void close_after_all();

 private:
  // Runs `task`. If it throws, closes the devices and returns the exception as an error.
  template <class Task>
  auto caught(Task task) -> decltype(task());
  // Runs `task` on the scanner's executor and returns its result.
  template <class Task>
  auto on_executor(Task task, bool beside_paused = false) -> decltype(task());
  // Runs a command on the scanner's executor, unless an emergency stop comes first.
  template <class Action>
  auto command(Action action) -> decltype(action());
  void remember(const Expected<ScannerIdentity>& seen);
  void look_again();

  ScannerBackend& backend_;
  JobQueue& jobs_;
  std::shared_future<void> looked_;  // the first look; valid after look_for_it()
  std::atomic<bool> is_looking_{false};

  std::mutex mutex_;  // guards the members below
  std::optional<ScannerIdentity> identity_;
  std::string problem_;
};

}  // namespace vitrine::server
