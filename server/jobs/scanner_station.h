// SPDX-License-Identifier: Apache-2.0
// A scanner between its jobs: what is known of it, and the commands that an operator gives by hand.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <optional>

#include "server/jobs/job_queue.h"
#include "server/jobs/scanner_backend.h"

namespace vitrine {

enum class ScannerState : std::uint8_t { kIdle, kBusy, kUnreachable };

struct ScannerStatus {
  std::string name;
  ScannerState state = ScannerState::kIdle;
  std::optional<ScannerIdentity> identity;  // as last seen; nothing before that
  std::optional<ScanId> scan;               // that it works on or has paused
  std::string problem;                      // why it is unreachable
};

// Thread-safe. Commands fail with kState while a job has the scanner, and with the devices' own
// errors.
class ScannerStation {
 public:
  // Both outlive it. Devices that no command was given to for `patience` are closed, for other
  // programs to use.
  ScannerStation(ScannerBackend& backend, JobQueue& jobs, std::chrono::milliseconds patience);

  // Has the scanner looked for, once; status() waits for that.
  void look_for_it();

  ScannerBackend& backend() { return backend_; }
  const std::string& name() const { return backend_.name(); }

  // Uses no device itself; one that is unreachable is looked for again meanwhile.
  ScannerStatus status();

  Expected<void> jog(double degrees);
  Expected<void> laser(bool on);
  Expected<Frame> picture();  // takes no stop back; also beside a scan that is paused

  // Laser and motor off at once, whatever is under way; a scan is paused, and a
  // calibration ends.
  void stop();

  // By the scanner's lane: who it is now. Closes the devices.
  void look();
  // Closes the devices once the lane has done what it has been given.
  void close_after_all();

 private:
  // What `task` throws is its error, not the end of the lane; the devices that it used are closed.
  template <class Task>
  auto caught(Task task) -> decltype(task());
  // Has `task` done by the scanner's lane, and returns what it returns.
  template <class Task>
  auto in_lane(Task task, bool beside_paused = false) -> decltype(task());
  // Does `action` with devices that are open, unless they are stopped between now and then.
  template <class Action>
  auto command(Action action) -> decltype(action());
  void remember(const Expected<ScannerIdentity>& seen);
  void look_again();

  ScannerBackend& backend_;
  JobQueue& jobs_;
  std::shared_future<void> looked_;  // valid once look_for_it() was called
  std::atomic<bool> looking_{false};

  std::mutex mutex_;  // guards what follows
  std::optional<ScannerIdentity> identity_;
  std::string problem_;
};

}  // namespace vitrine
