// SPDX-License-Identifier: Apache-2.0
// From where a scan stands to its last step, on the thread that owns the devices. Per step: turn,
// frame without laser, frame with laser, profile, disk.
//
// While the table turns and the camera exposes step k, the profile of step k - 1 is found and
// written on another thread; step k + 1 does not begin before that is on disk. So the disk is at
// most one step behind the table, the camera never waits for us, and what a crash loses is scanned
// again. The journal also says where the table stands, for boards that forget.
#pragma once

#include <chrono>
#include <future>

#include "acquisition/calibration/calibration.h"
#include "acquisition/session/live_preview.h"
#include "acquisition/session/profile_journal.h"
#include "acquisition/session/scan_folder.h"
#include "acquisition/session/scanner.h"
#include "acquisition/session/stripe_watch.h"

namespace vitrine {

// How long a scan waits for a device that is gone.
struct Patience {
  int tries = 60;  // to go on, without a step done in between
  // To begin: a device may still be held by a process that was killed.
  int first_tries = 10;
  // To turn a table that does not turn, in all: what jams it stays, and with each try the place of
  // the table is less certain.
  int turns = 2;
  std::chrono::milliseconds between{500};
};

// Who is told about a run, and may end it.
class ScanWatch {
 public:
  virtual ~ScanWatch() = default;

  virtual bool is_interrupted() const = 0;
  // Returns early when it is interrupted.
  virtual void sleep(std::chrono::milliseconds at_most) = 0;
  virtual void checks_passed() = 0;
  virtual void step_done(int steps_done, const StripeCount& so_far) = 0;
  virtual void waits_for(const Error& lost) = 0;
};

class ScanRun {
 public:
  // All of them outlive the run.
  struct Means {
    const Scanner& scanner;
    const ScanRequest& request;
    const ScanFolder& folder;
    EmergencyStop& stop;
    LivePreview& preview;
    ScanWatch& watch;
    Patience patience;
  };

  explicit ScanRun(const Means& means) : means_(means) {}

  // Goes on until all steps are on disk or the watch interrupts it; laser and motor are off on
  // return. Fails with what stopped it; a later run goes on from there.
  Expected<void> run();

  std::vector<Profile> take_profiles() { return std::move(profiles_); }
  const Calibration& calibration() const { return calibration_; }

 private:
  // Opening the devices anew helps where one was lost, and hardly where the table does not turn.
  enum class Cause { kScan, kDevice, kMotion };
  struct Setback {
    Error error;
    Cause cause = Cause::kScan;
  };
  using Outcome = tl::expected<void, Setback>;

  // Setbacks since the last step that was done.
  struct Tries {
    int all = 0, turns = 0;
  };

  static tl::unexpected<Setback> of_device(const Error& error, Cause cause = Cause::kDevice);
  static tl::unexpected<Setback> of_scan(const Error& error);

  bool is_worth_a_try(Cause cause, const Tries& tries) const;
  Outcome scan_on();
  Outcome prepare(LiveScanner& scanner);
  Expected<void> identify(const LiveScanner& scanner);
  Outcome look(LiveScanner& scanner);
  Expected<void> begin(const LiveScanner& scanner);
  Outcome turn(LiveScanner& scanner, int step);
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
  std::vector<StripeCount> stripes_;  // of profiles_
  StripeCount seen_;                  // in all of them
  Measured fresh_;  // of step profiles_.size(); the other thread's until pending_ is there
  std::future<Expected<void>> pending_;
  int stands_at_ = 0;  // the step that the table was turned to last, as the journal says, too
  bool is_checked_ = false;
};

}  // namespace vitrine
