// SPDX-License-Identifier: Apache-2.0
// The state of a scanner and an operator's manual commands to it, while no job uses the scanner.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
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
  std::optional<ScannerIdentity> identity;  // identity as last seen; nullopt if never seen
  std::optional<ScanId> scan;               // the running or paused scan
  std::string problem;                      // why the scanner is unreachable
  acquisition::BoardPower power;            // state of laser and motor
};

// Returns whether a laser that an operator has switched on may stay on. May block, and must be
// thread-safe.
using LaserPermit = std::function<bool()>;

// A laser that an operator has switched on is switched off after this time.
inline constexpr std::chrono::seconds kLongestLit{60};
// If a command still occupies the board this long after the time at which the laser had to be off,
// the station makes an emergency stop.
inline constexpr std::chrono::seconds kLaserGrace{2};

// Thread-safe. Commands fail with kState while a job uses the scanner, and with the errors of the
// devices.
class ScannerStation {
 public:
  using Clock = std::chrono::steady_clock;

  // `backend` and `jobs` must outlive the station. Devices without a command for `idle_timeout` are
  // closed, so that other programs can use them. `now` is the clock for kLongestLit.
  ScannerStation(ScannerBackend& backend, JobQueue& jobs, std::chrono::milliseconds idle_timeout,
                 std::function<Clock::time_point()> now = Clock::now);

  // Starts the first search for the scanner. Call this once. status() waits briefly for the result.
  void look_for_it();

  ScannerBackend& backend() { return backend_; }
  const std::string& name() const { return backend_.name(); }

  // Returns the state without using a device. If the scanner is unreachable, starts to
  // search for it again in the background.
  ScannerStatus status();

  Expected<void> jog(double degrees);
  // Switches the laser on. It stays on until it is switched off, kLongestLit has passed, `permit`
  // returns false, the table has been jogged, or a job begins.
  Expected<void> switch_laser_on(LaserPermit permit);
  Expected<void> switch_laser_off();
  // Takes a picture. Works even during a paused scan. An emergency stop stays in force.
  Expected<acquisition::Frame> picture();

  // Turns laser and motor off at once. Pauses a running scan and ends a running calibration.
  void stop();

  // Looks for the scanner: identifies its devices and closes them. Runs on the scanner's executor.
  void look();
  // Switches off a laser that an operator has switched on. Runs on the scanner's executor.
  void switch_manual_laser_off();
  // If an operator has switched the laser on, keeps it on, or switches it off once its time limit
  // has passed or its permit has ended. Call this once a second.
  void watch_manual_laser();
  // Posts a task to the scanner's executor that closes the devices.
  void close_after_all();

 private:
  // Runs `task`. If it throws, closes the devices and returns the exception as an error.
  template <class Task>
  auto caught(Task task) -> decltype(task());
  // Runs `task` on the scanner's executor and returns its result.
  template <class Task>
  auto on_executor(Task task, bool beside_paused = false) -> decltype(task());
  // Runs a command on the scanner's executor, unless there is an emergency stop before its turn.
  template <class Action>
  auto command(Action action) -> decltype(action());
  // Returns the time at which the lit laser must be off, or nullopt if no operator has switched it
  // on.
  std::optional<Clock::time_point> laser_end();
  void forget_laser();
  void keep_laser_or_put_it_out();
  void remember(const Expected<ScannerIdentity>& seen);
  void look_again();

  ScannerBackend& backend_;
  JobQueue& jobs_;
  std::shared_future<void> looked_;  // the first search; valid after look_for_it()
  std::atomic<bool> is_looking_{false};
  // whether a task for watch_manual_laser() is waiting or running
  std::atomic<bool> is_tending_{false};
  const std::function<Clock::time_point()> now_;

  std::mutex mutex_;  // guards the members below
  std::optional<ScannerIdentity> identity_;
  std::string problem_;
  struct LitLaser {
    Clock::time_point end;
    LaserPermit permit;
  };
  std::optional<LitLaser> lit_;  // set while a laser is on that an operator has switched on
};

}  // namespace vitrine::server
