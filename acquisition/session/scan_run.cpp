// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/scan_run.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <utility>

#include "acquisition/calibration/calibration_store.h"
#include "acquisition/session/first_look.h"
#include "acquisition/session/scan_calibration.h"

namespace vitrine::acquisition {
namespace {

std::string now_as_text() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

std::string board_name(const BoardIdentity& board) {
  return board.serial.empty() ? board.dialect : board.dialect + " " + board.serial;
}

Expected<void> same_camera(const ScanRecord& record, const LiveScanner& scanner) {
  if (scanner.camera().serial == record.camera && scanner.region() == record.settings.region)
    return {};
  return fail(
      ErrorCode::kBadInput,
      fmt::format("the scan was started with camera {}, this is camera {} or another region; "
                  "connect that camera and set its region, or start a new scan",
                  record.camera, scanner.camera().serial));
}

Error stuck(const Error& error) {
  return {error.code, "the table does not turn: " + error.message};
}

}  // namespace

tl::unexpected<ScanRun::Setback> ScanRun::of_device(const Error& error, Cause cause) {
  return tl::unexpected(Setback{error, error.code == ErrorCode::kIo ? cause : Cause::kScan});
}

tl::unexpected<ScanRun::Setback> ScanRun::of_scan(const Error& error) {
  return tl::unexpected(Setback{error, Cause::kScan});
}

Expected<void> ScanRun::open_folder() {
  JournalContents contents;
  auto journal = ProfileJournal::open(means_.folder.journal(), contents);
  if (!journal) return tl::unexpected(journal.error());
  journal_ = std::move(*journal);
  profiles_ = std::move(contents.profiles);
  stands_at_ = contents.stands_at.value_or(0);
  stripes_ = std::move(contents.stripes);
  seen_ = sum(stripes_);
  stripe_watch_.emplace(means_.request.steps, contents.given_up_at);
  Expected<void> judged;
  for (int step = 0; step < steps_done(); ++step)
    judged = stripe_watch_->add(stripes_[step], step + 1);
  // `judged` now holds the judgement of the last step. It is an error only if an earlier process
  // stored that step and crashed before judging it.
  if (!judged) return refuse(judged.error());
  auto record = means_.folder.record();
  if (!record) return tl::unexpected(record.error());
  record_ = std::move(*record);
  if (!record_) return {};
  auto calibration = calibration_of(*record_, means_.scanner.calibrations);
  if (!calibration) return tl::unexpected(calibration.error());
  calibration_ = std::move(*calibration);
  return {};
}

Expected<void> ScanRun::run() {
  if (auto opened = open_folder(); !opened) return opened;
  Tries tries;
  while (steps_done() < means_.request.steps && !means_.watch.is_interrupted()) {
    const int before = steps_done();
    StepOutcome outcome = scan_on();
    if (auto settled = settle(); !settled) outcome = of_scan(settled.error());
    if (outcome) continue;
    const auto& [error, cause] = outcome.error();
    if (steps_done() > before) tries = {};
    ++tries.all;
    if (cause == Cause::kMotion) ++tries.turns;
    if (!is_worth_a_try(cause, tries))
      return tl::unexpected(cause == Cause::kMotion ? stuck(error) : error);
    means_.watch.waits_for(error);
    means_.watch.sleep(means_.retries.between);
  }
  return {};
}

bool ScanRun::is_worth_a_try(Cause cause, const Tries& tries) const {
  const auto& [most, at_first, turns, between] = means_.retries;
  if (cause == Cause::kScan || tries.all > (is_checked_ ? most : at_first)) return false;
  return cause != Cause::kMotion || tries.turns < turns;
}

ScanRun::StepOutcome ScanRun::scan_on() {
  auto scanner = LiveScanner::open(means_.scanner.devices, settings(), means_.stop);
  if (!scanner) return of_device(scanner.error());
  if (auto prepared = prepare(*scanner); !prepared) return prepared;
  for (int step = steps_done(); step < means_.request.steps; ++step) {
    if (means_.watch.is_interrupted()) return {};
    auto frames = take(*scanner, step);
    if (!frames) return tl::unexpected(frames.error());
    if (auto settled = settle(); !settled) return of_scan(settled.error());
    measure(step, std::move(*frames));
  }
  return {};
}

CameraSettings ScanRun::settings() const {
  if (record_) return record_->settings;
  CameraSettings settings = means_.scanner.settings;
  settings.exposure_us = means_.request.exposure_us.value_or(settings.exposure_us);
  return settings;
}

ScanRun::StepOutcome ScanRun::prepare(LiveScanner& scanner) {
  if (auto known = identify(scanner); !known) return of_scan(known.error());
  if (auto found = scanner.find_position(angle_of(means_.request, stands_at_)); !found)
    return of_device(found.error(), Cause::kMotion);
  if (!is_checked_) {
    if (auto seen = look(scanner); !seen) return seen;
    if (auto begun = begin(scanner); !begun) return of_scan(begun.error());
    is_checked_ = true;
    means_.watch.checks_passed();
  }
  return {};
}

// Chooses the calibration: the requested one, or the newest one for this camera and region.
Expected<void> ScanRun::identify(const LiveScanner& scanner) {
  if (record_) return same_camera(*record_, scanner);
  const CalibrationStore store(means_.scanner.calibrations);
  const int chosen = means_.request.calibration;
  const std::string& serial = scanner.camera().serial;
  auto calibration = chosen == 0 ? store.for_camera(serial, scanner.region()) : store.load(chosen);
  if (!calibration) return tl::unexpected(calibration.error());
  if (auto possible = fits(*calibration, serial, scanner.region()); !possible) return possible;
  calibration_ = std::move(*calibration);
  return {};
}

// Checks whether the scanner sees the object. An object may miss the laser plane at one angle, so
// up to four angles are tried.
ScanRun::StepOutcome ScanRun::look(LiveScanner& scanner) {
  const int steps = means_.request.steps;
  FirstLook seen(calibration_, means_.request.processing.stripe);
  for (int quarter = 0; quarter < 4; ++quarter) {
    if (means_.watch.is_interrupted()) return {};
    const int step = (steps_done() + quarter * steps / 4) % steps;
    auto frames = take(scanner, step);
    if (!frames) return tl::unexpected(frames.error());
    means_.preview.show(frames->lit);
    if (auto added = seen.add(*frames, angle_of(means_.request, step)); !added)
      return of_scan(added.error());
    if (seen.judgement()) return {};
  }
  return of_scan(seen.judgement().error());
}

Expected<void> ScanRun::begin(const LiveScanner& scanner) {
  if (record_) return {};
  ScanRecord record{.request = means_.request,
                    .created = now_as_text(),
                    .scanner = means_.scanner.name,
                    .camera = scanner.camera().serial,
                    .settings = settings(),
                    .board = board_name(scanner.board()),
                    .calibration = calibration_.number,
                    .calibration_digest = digest_of(calibration_)};
  record.settings.region = scanner.region();
  if (auto written = means_.folder.write_record(record); !written) return written;
  record_ = std::move(record);
  return {};
}

// Turns the table to a step. Records the step first, because a table completes its motion even if
// this process is killed. If the motion fails, the table stands somewhere between the two
// positions. The position before the motion is then recorded as the best estimate.
ScanRun::StepOutcome ScanRun::turn(LiveScanner& scanner, int step) {
  if (auto noted = journal_->note_turn(step); !noted) return of_scan(noted.error());
  const auto turned = scanner.turn_to(angle_of(means_.request, step));
  if (!turned) {
    if (auto noted = journal_->note_turn(stands_at_); !noted) return of_scan(noted.error());
    return of_device(turned.error(), Cause::kMotion);
  }
  stands_at_ = step;
  return {};
}

tl::expected<FramePair, ScanRun::Setback> ScanRun::take(LiveScanner& scanner, int step) {
  if (auto turned = turn(scanner, step); !turned) return tl::unexpected(turned.error());
  auto frames = scanner.capture_pair();
  if (!frames) return of_device(frames.error());
  return std::move(*frames);
}

void ScanRun::measure(int step, FramePair frames) {
  pending_ = std::async(std::launch::async, [this, step, frames = std::move(frames)]() mutable {
    return measure_and_store(step, std::move(frames));
  });
}

Expected<void> ScanRun::measure_and_store(int step, FramePair frames) {
  const ScanRequest& request = means_.request;
  auto measured =
      measure_profile(frames, calibration_, request.processing.stripe, angle_of(request, step));
  if (!measured) return tl::unexpected(measured.error());
  if (request.keeps_frames) {
    if (auto kept = means_.folder.write_frames(step, frames); !kept) return kept;
  }
  if (auto stored = journal_->append(measured->profile, measured->stripe); !stored) return stored;
  means_.preview.show(std::move(frames.lit));
  means_.preview.add(measured->profile);
  fresh_ = std::move(*measured);
  return {};
}

// Waits until the profile in progress is on disk.
Expected<void> ScanRun::settle() {
  if (!pending_.valid()) return {};
  if (auto stored = pending_.get(); !stored) return stored;
  profiles_.push_back(std::move(fresh_.profile));
  stripes_.push_back(fresh_.stripe);
  seen_ = seen_ + fresh_.stripe;
  means_.watch.step_done(steps_done(), seen_);
  const auto judged = stripe_watch_->add(fresh_.stripe, steps_done());
  return judged ? Expected<void>{} : refuse(judged.error());
}

// Discards the steps that the stripe watch has just judged, and returns `judgement`. A resumed scan
// measures these steps again.
Expected<void> ScanRun::refuse(const Error& judgement) {
  const int kept = steps_done() - stripe_watch_->span();
  if (auto noted = journal_->give_up(kept, steps_done()); !noted) return noted;
  profiles_.resize(static_cast<std::size_t>(kept));
  stripes_.resize(static_cast<std::size_t>(kept));
  seen_ = sum(stripes_);
  means_.watch.step_done(kept, seen_);
  return tl::unexpected(judgement);
}

}  // namespace vitrine::acquisition
