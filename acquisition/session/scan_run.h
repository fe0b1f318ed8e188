// SPDX-License-Identifier: Apache-2.0
// Runs a scan from its current step to the last, on the thread that owns the devices. Each step
// turns the table, takes a frame without laser and one with laser, computes the profile and writes
// it to disk.
//
// While the table turns and the camera exposes step k, another thread computes and writes the
// profile of step k - 1. Step k + 1 starts only when that profile is on disk. The disk is therefore
// at most one step behind the table. The camera waits only if computing and writing a profile takes
// longer than a step. Steps lost in a crash are scanned again. The journal also records the table's
// angle, for boards that forget it.
#pragma once

#include <chrono>
#include <future>

#include "acquisition/calibration/calibration.h"
#include "acquisition/session/live_preview.h"
#include "acquisition/session/profile_journal.h"
#include "acquisition/session/scan_folder.h"
#include "acquisition/session/scanner.h"
#include "acquisition/session/stripe_watch.h"

namespace vitrine::acquisition {

// How often and how long a scan retries after it has lost a device.
struct RetryLimits {
  int tries = 60;  // number of consecutive attempts to resume that complete no step
  // Number of attempts to start. The first attempt may fail because a killed process still holds a
  // device.
  int first_tries = 10;
  // Number of consecutive attempts to turn a stalled table that complete no step. A jam does not
  // clear itself, and each attempt makes the table's angle less certain.
  int turns = 2;
  std::chrono::milliseconds between{500};
};

// Receives a run's progress and may interrupt the run.
class ScanWatch {
 public:
  virtual ~ScanWatch() = default;

  virtual bool is_interrupted() const = 0;
  // Sleeps for the time `at_most`, or less if the run is interrupted.
  virtual void sleep(std::chrono::milliseconds at_most) = 0;
  virtual void checks_passed() = 0;
  virtual void step_done(int steps_done, const StripeCount& so_far) = 0;
  virtual void waits_for(const Error& lost) = 0;
};

class ScanRun {
 public:
  // The inputs of a run. Every member must outlive the run.
  struct Means {
    const Scanner& scanner;
    const ScanRequest& request;
    const ScanFolder& folder;
    EmergencyStop& stop;
    LivePreview& preview;
    ScanWatch& watch;
    RetryLimits retries;
  };

  explicit ScanRun(const Means& means) : means_(means) {}

  // Scans until all steps are on disk or the watch interrupts the run. Laser and motor are off when
  // the function returns. Fails with the error that stopped the scan. A later run continues after
  // the steps on disk.
  Expected<void> run();

  std::vector<Profile> take_profiles() { return std::move(profiles_); }
  const Calibration& calibration() const { return calibration_; }

 private:
  // The kind of failure. Reopening the devices helps if a device was lost, but rarely if the table
  // does not turn.
  enum class Cause { kScan, kDevice, kMotion };
  struct Setback {
    Error error;
    Cause cause = Cause::kScan;
  };
  using StepOutcome = tl::expected<void, Setback>;

  // Numbers of failed attempts since the last completed step: of all attempts, and of the attempts
  // to turn the table.
  struct Tries {
    int all = 0, turns = 0;
  };

  static tl::unexpected<Setback> of_device(const Error& error, Cause cause = Cause::kDevice);
  static tl::unexpected<Setback> of_scan(const Error& error);

  bool is_worth_a_try(Cause cause, const Tries& tries) const;
  StepOutcome scan_on();
  StepOutcome prepare(LiveScanner& scanner);
  Expected<void> identify(const LiveScanner& scanner);
  StepOutcome look(LiveScanner& scanner);
  Expected<void> begin(const LiveScanner& scanner);
  StepOutcome turn(LiveScanner& scanner, int step);
  tl::expected<FramePair, Setback> take(LiveScanner& scanner, int step);
  void measure(int step, FramePair frames);
  Expected<void> measure_and_store(int step, FramePair frames);
  Expected<void> settle();
  Expected<void> refuse(const Error& judgement);
  Expected<void> open_folder();

  CameraSettings settings() const;
  int steps_done() const { return static_cast<int>(profiles_.size()); }

  Means means_;
  std::optional<ScanRecord> record_;
  Calibration calibration_;
  std::optional<ProfileJournal> journal_;
  std::vector<Profile> profiles_;
  std::optional<StripeWatch> stripe_watch_;
  std::vector<StripeCount> stripes_;  // the stripe counts of profiles_
  StripeCount seen_;                  // sum of stripes_
  // The result for step profiles_.size(). Only the thread that computes it may use it until
  // pending_ completes.
  Measured fresh_;
  std::future<Expected<void>> pending_;
  // The step to which the table was last turned. The journal records this step too.
  int stands_at_ = 0;
  bool is_checked_ = false;
};

}  // namespace vitrine::acquisition
