// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/scanner_station.h"

#include <fmt/format.h>

#include <exception>

namespace vitrine::server {
namespace {

// Longest time that status() waits for the first look.
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
                               std::chrono::milliseconds idle_timeout)
    : backend_(backend), jobs_(jobs) {
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
  if (!seen && seen.error().code == ErrorCode::kState) return;  // stopped, not unreachable
  const std::scoped_lock lock(mutex_);
  if (seen) identity_ = *seen;
  problem_ = seen ? "" : seen.error().message;
}

// Looks for the scanner again, because it may have been connected. Only one look runs at a time,
// and none while the scanner has an unfinished job.
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
    looked_.wait_for(kLookTimeout);  // only without a job, because a job may delay the look
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
  return command([&] { return backend_.jog(degrees); });
}

Expected<void> ScannerStation::laser(bool on) {
  return command([&] { return backend_.laser(on); });
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
  backend_.emergency_stop();  // first, because nothing may delay it
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
