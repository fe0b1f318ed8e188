// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/scanner_station.h"

#include <fmt/format.h>

#include <exception>

namespace vitrine {
namespace {

constexpr std::chrono::seconds kPatience{3};  // with a scanner that is looked for
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
                               std::chrono::milliseconds patience)
    : backend_(backend), jobs_(jobs) {
  jobs_.lane(name()).when_idle(patience, [this] { backend_.close(); });
}

void ScannerStation::look_for_it() {
  const auto done = std::make_shared<std::promise<void>>();
  looked_ = done->get_future().share();
  jobs_.lane(name()).post([this, done] {
    look();
    done->set_value();
  });
}

void ScannerStation::look() {
  remember(caught([this] { return backend_.identify(); }));
  backend_.close();
}

void ScannerStation::remember(const Expected<ScannerIdentity>& seen) {
  if (!seen && seen.error().code == ErrorCode::kState) return;  // stopped: that is no absence
  const std::scoped_lock lock(mutex_);
  if (seen) identity_ = *seen;
  problem_ = seen ? "" : seen.error().message;
}

// It may have been plugged in. One look at a time, and none that a job would have to wait for.
void ScannerStation::look_again() {
  if (looking_.exchange(true)) return;
  const auto posted = jobs_.post_command(name(), [this] {
    look();
    looking_ = false;
  });
  if (!posted) looking_ = false;
}

ScannerStatus ScannerStation::status() {
  const auto job = jobs_.job_of(name());
  if (!job && looked_.valid()) looked_.wait_for(kPatience);  // a job may be in front of the look
  ScannerStatus status{.name = name()};
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
  }
  return status;
}

template <class Task>
auto ScannerStation::in_lane(Task task, bool beside_paused) -> decltype(task()) {
  std::promise<decltype(task())> done;
  const auto posted = jobs_.post_command(
      name(), [&] { done.set_value(task()); }, beside_paused);
  if (!posted) return Unexpected(posted.error());
  return done.get_future().get();
}

template <class Action>
auto ScannerStation::command(Action action) -> decltype(action()) {
  return in_lane([&, stops = backend_.stops()]() -> decltype(action()) {
    backend_.allow(stops);
    const auto seen = caught([this] { return backend_.identify(); });
    auto done = seen ? caught(action) : decltype(action())(Unexpected(seen.error()));
    remember(done ? seen : Unexpected(done.error()));
    return done;
  });
}

Expected<void> ScannerStation::jog(double degrees) {
  return command([&] { return backend_.jog(degrees); });
}

Expected<void> ScannerStation::laser(bool on) {
  return command([&] { return backend_.laser(on); });
}

Expected<Frame> ScannerStation::picture() {
  const auto capture = [&] {
    auto frame = caught([this] { return backend_.picture(); });
    if (!frame) remember(Unexpected(frame.error()));
    return frame;
  };
  return in_lane(capture, /*beside_paused=*/true);
}

void ScannerStation::stop() {
  backend_.emergency_stop();  // first of all
  const auto job = jobs_.job_of(name());
  if (!job) return;
  const bool can_be_resumed = job->record.kind == JobKind::kScan;
  static_cast<void>(can_be_resumed ? jobs_.pause(job->record.id, kStopped)
                                   : jobs_.cancel(job->record.id));
}

void ScannerStation::close_after_all() {
  jobs_.lane(name()).post([this] { backend_.close(); });
}

}  // namespace vitrine
