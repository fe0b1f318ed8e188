// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/scanner_station.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

namespace vitrine::server {
namespace {

// Longest time that status() waits for the result of the first search for the scanner.
constexpr std::chrono::seconds kLookTimeout{3};
constexpr std::string_view kStopped =
    "stopped by the operator; make sure that it is safe, then resume";

Unexpected thrown(const std::exception& fault) {
  return fail(ErrorCode::kIo, fmt::format("the scanner cannot be used: {}; free memory and try "
                                          "again",
                                          fault.what()));
}

}  // namespace

template <class Task>
auto ScannerStation::caught(Task task) -> decltype(task()) try {
  return task();
} catch (const std::exception& fault) {
  backend_.close();
  return thrown(fault);
}

ScannerStation::ScannerStation(ScannerBackend& backend, JobQueue& jobs,
                               std::chrono::milliseconds idle_timeout,
                               std::function<Clock::time_point()> now)
    : backend_(backend), jobs_(jobs), now_(std::move(now)) {
  jobs_.executor(name()).when_idle(idle_timeout, [this] { backend_.close(); });
}

void ScannerStation::look_for_it() {
  const auto done = std::make_shared<std::promise<void>>();
  looked_ = done->get_future().share();
  jobs_.executor(name()).post([this, done] {
    look();
    done->set_value();
  });
}

void ScannerStation::look() {
  remember(caught([this] { return backend_.identify(); }));
  backend_.close();
}

void ScannerStation::remember(const Expected<ScannerIdentity>& seen) {
  // The error kState means that an emergency stop is in force. The scanner is then still reachable.
  if (!seen && seen.error().code == ErrorCode::kState) return;
  const std::scoped_lock lock(mutex_);
  if (seen) identity_ = *seen;
  problem_ = seen ? "" : seen.error().message;
}

// Searches for the scanner again, because it may have been connected in the meantime. Only one
// search runs at a time. Does not search while the scanner has an unfinished job.
void ScannerStation::look_again() {
  if (is_looking_.exchange(true)) return;
  const auto posted = jobs_.post_command(name(), [this] {
    look();
    is_looking_ = false;
  });
  if (!posted) is_looking_ = false;
}

ScannerStatus ScannerStation::status() {
  const auto job = jobs_.job_of(name());
  if (!job && looked_.valid())
    // If a job runs, the search for the scanner may wait for the end of the job. Therefore waits
    // for the search only if there is no job.
    looked_.wait_for(kLookTimeout);
  ScannerStatus status{.name = name(), .power = backend_.power()};
  {
    const std::scoped_lock lock(mutex_);
    status.identity = identity_;
    status.problem = problem_;
  }
  if (job) {
    status.state = ScannerState::kBusy;
    status.scan = job->record.scan;
  } else if (!status.problem.empty()) {
    status.state = ScannerState::kUnreachable;
    look_again();
  } else if (status.power.laser == acquisition::LaserState::kUnknown) {
    look_again();  // opening the board for the search switches laser and motor off
  }
  return status;
}

template <class Task>
auto ScannerStation::on_executor(Task task, bool beside_paused) -> decltype(task()) {
  std::promise<decltype(task())> done;
  const auto posted = jobs_.post_command(
      name(), [&] { done.set_value(task()); }, beside_paused);
  if (!posted) return tl::unexpected(posted.error());
  return done.get_future().get();
}

template <class Action>
auto ScannerStation::command(Action action) -> decltype(action()) {
  return on_executor([&, stops = backend_.stops()]() -> decltype(action()) {
    backend_.allow(stops);
    const auto seen = caught([this] { return backend_.identify(); });
    auto done = seen ? caught(action) : decltype(action())(tl::unexpected(seen.error()));
    remember(done ? seen : tl::unexpected(done.error()));
    return done;
  });
}

Expected<void> ScannerStation::jog(double degrees) {
  return command([&] {
    auto done = backend_.jog(degrees);
    forget_laser();  // the laser is off after a motion and after an error
    return done;
  });
}

Expected<void> ScannerStation::switch_laser_on(LaserPermit permit) {
  return command([&]() -> Expected<void> {
    {
      const std::scoped_lock lock(mutex_);
      lit_ = LitLaser{now_() + kLongestLit, permit};
    }
    auto done = backend_.laser(true);
    if (!done) forget_laser();
    return done;
  });
}

Expected<void> ScannerStation::switch_laser_off() {
  return command([&] {
    auto done = backend_.laser(false);
    forget_laser();  // also after an error, because an error closes the devices
    return done;
  });
}

std::optional<ScannerStation::Clock::time_point> ScannerStation::laser_end() {
  const std::scoped_lock lock(mutex_);
  return lit_ ? std::optional(lit_->end) : std::nullopt;
}

void ScannerStation::forget_laser() {
  const std::scoped_lock lock(mutex_);
  lit_.reset();
}

void ScannerStation::switch_manual_laser_off() {
  if (!laser_end()) return;
  const auto off = caught([this] { return backend_.laser(false); });
  // closing switches the laser off, or makes the guardian process do so
  if (!off) backend_.close();
  forget_laser();
}

void ScannerStation::keep_laser_or_put_it_out() {
  const auto end = laser_end();
  if (!end) return;
  if (now_() >= *end) return switch_manual_laser_off();
  if (!caught([this] { return backend_.keep_laser(); })) forget_laser();
}

void ScannerStation::watch_manual_laser() {
  std::optional<LitLaser> lit;
  {
    const std::scoped_lock lock(mutex_);
    lit = lit_;
  }
  if (!lit) return;
  if (!lit->permit()) {
    const std::scoped_lock lock(mutex_);
    if (lit_ && lit_->end == lit->end) lit_->end = lit->end = std::min(lit->end, now_());
  }
  if (now_() >= lit->end + kLaserGrace) {
    forget_laser();
    return backend_.emergency_stop();
  }
  if (is_tending_.exchange(true)) return;
  const auto posted = jobs_.post_command(name(), [this] {
    keep_laser_or_put_it_out();
    is_tending_ = false;
  });
  if (!posted) is_tending_ = false;
}

Expected<acquisition::Frame> ScannerStation::picture() {
  const auto capture = [&] {
    auto frame = caught([this] { return backend_.picture(); });
    if (!frame) remember(tl::unexpected(frame.error()));
    return frame;
  };
  return on_executor(capture, /*beside_paused=*/true);
}

void ScannerStation::stop() {
  backend_.emergency_stop();  // comes first, because nothing may delay it
  forget_laser();
  const auto job = jobs_.job_of(name());
  if (!job) return;
  const bool can_be_resumed = job->record.kind == JobKind::kScan;
  static_cast<void>(can_be_resumed ? jobs_.pause(job->record.id, kStopped)
                                   : jobs_.cancel(job->record.id));
}

void ScannerStation::close_after_all() {
  jobs_.executor(name()).post([this] { backend_.close(); });
}

}  // namespace vitrine::server
