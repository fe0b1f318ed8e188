// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace vitrine::acquisition {
namespace {

// Share of the scanning steps in the total progress. Making the mesh is the rest.
constexpr double kScanningShare = 0.97;

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Unexpected not_now(const char* what, ScanState state) {
  return fail(ErrorCode::kState, fmt::format("cannot {} a scan that is {}; check its state first",
                                             what, name_of(state)));
}

Error error_of(const std::exception& fault) {
  std::string words = fault.what();
  std::ranges::replace(words, '\n', ' ');  // OpenCV's messages have several lines
  return {ErrorCode::kIo,
          fmt::format("the scan cannot continue: {}; free memory and resume it", words)};
}

}  // namespace

Expected<std::unique_ptr<Scan>> Scan::create(Scanner scanner, const ScanRequest& request,
                                             const std::filesystem::path& folder,
                                             ScanSettings settings) {
  if (auto possible = check(request); !possible) return tl::unexpected(possible.error());
  auto made = ScanFolder::create(folder);
  if (!made) return tl::unexpected(made.error());
  return std::unique_ptr<Scan>(
      new Scan(std::move(scanner), request, std::move(*made), std::move(settings)));
}

Expected<std::unique_ptr<Scan>> Scan::reopen(Scanner scanner, const std::filesystem::path& folder,
                                             ScanSettings settings) {
  auto opened = ScanFolder::open(folder);
  if (!opened) return tl::unexpected(opened.error());
  const auto record = opened->record();
  if (!record) return tl::unexpected(record.error());
  const auto measured = opened->measured();
  if (!measured) return tl::unexpected(measured.error());
  std::unique_ptr<Scan> scan(
      new Scan(std::move(scanner), (*record)->request, std::move(*opened), std::move(settings)));
  for (const Profile& profile : measured->profiles)
    scan->preview_.add(profile);
  const StoredState stored = scan->folder_.state();
  const std::lock_guard lock(scan->mutex_);
  scan->status_.state = stored.state;
  scan->status_.error = stored.error;
  scan->status_.steps_done = static_cast<int>(measured->profiles.size());
  scan->status_.stripe = sum(measured->stripes);
  scan->status_.progress = kScanningShare * scan->status_.steps_done / scan->status_.steps;
  return scan;
}

Scan::Scan(Scanner scanner, const ScanRequest& request, ScanFolder folder, ScanSettings settings)
    : scanner_(std::move(scanner)),
      request_(request),
      folder_(std::move(folder)),
      settings_(std::move(settings)),
      preview_(request.steps) {
  status_.steps = request.steps;
}

Scan::~Scan() {
  (void)pause();  // fails if the scan is not running, which is no fault here
  if (thread_.joinable()) thread_.join();
}

Expected<void> Scan::resume() try {
  const std::lock_guard lock(mutex_);
  if (is_running(status_.state)) return not_now("start", status_.state);
  if (status_.state == ScanState::kCancelled) return not_now("resume", status_.state);
  requested_ = RequestedAction::kRun;
  stop_.release(stop_.presses());
  if (thread_.joinable())
    thread_.join();  // returns at once, because the thread's last action was to set the state
  thread_ = std::jthread([this] { work(); });
  status_.error.reset();
  surface_.reset();
  enter(ScanState::kChecking);
  return {};
} catch (const std::exception& fault) {  // for example, the system could not start the thread
  return tl::unexpected(error_of(fault));
}

Expected<void> Scan::pause() {
  const std::lock_guard lock(mutex_);
  if (status_.state != ScanState::kChecking && status_.state != ScanState::kScanning)
    return not_now("pause", status_.state);
  if (requested_ == RequestedAction::kRun) requested_ = RequestedAction::kPause;
  changed_.notify_all();
  return {};
}

Expected<void> Scan::cancel() {
  const std::lock_guard lock(mutex_);
  if (status_.state == ScanState::kDone || status_.state == ScanState::kCancelled)
    return not_now("cancel", status_.state);
  requested_ = RequestedAction::kCancel;
  if (is_running(status_.state)) {
    changed_.notify_all();
    return {};
  }
  enter(ScanState::kCancelled);
  return folder_.write_state({.state = ScanState::kCancelled});
}

void Scan::emergency_stop() noexcept {
  stop_.press();
  changed_.notify_all();
}

ScanStatus Scan::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

ScanStatus Scan::wait(std::chrono::milliseconds at_most) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, at_most, [&] { return !is_running(status_.state); });
  return status_;
}

std::shared_ptr<const ScannedSurface> Scan::surface() const {
  const std::lock_guard lock(mutex_);
  return surface_;
}

bool Scan::is_interrupted() const {
  const std::lock_guard lock(mutex_);
  return requested_ != RequestedAction::kRun;
}

void Scan::sleep(std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, at_most,
                    [&] { return requested_ != RequestedAction::kRun || stop_.is_pressed(); });
}

void Scan::checks_passed() {
  const std::lock_guard lock(mutex_);
  started_ = now(), steps_before_ = status_.steps_done;
  enter(ScanState::kScanning);
}

void Scan::step_done(int steps_done, const StripeCount& so_far) {
  const std::lock_guard lock(mutex_);
  status_.note.clear();
  status_.steps_done = steps_done;
  status_.stripe = so_far;
  status_.progress = kScanningShare * steps_done / status_.steps;
  const int in_this_run = steps_done - steps_before_;
  if (in_this_run > 0) {
    status_.seconds_left =
        (now() - started_) / in_this_run * (status_.steps - steps_done) / kScanningShare;
  }
}

void Scan::waits_for(const Error& lost) {
  const std::lock_guard lock(mutex_);
  status_.note = lost.message;
  status_.seconds_left.reset();
}

double Scan::now() const {
  return settings_.seconds ? settings_.seconds() : steady_seconds();
}

void Scan::enter(ScanState state) {
  status_.state = state;
  status_.note.clear();
  status_.seconds_left.reset();
  if (state == ScanState::kDone) status_.progress = 1;
  changed_.notify_all();
}

void Scan::work() {
  auto outcome = run_and_mesh();
  const std::lock_guard lock(mutex_);
  StoredState end;  // the default state is paused
  if (requested_ == RequestedAction::kCancel) {
    end.state = ScanState::kCancelled;
  } else if (!outcome) {
    end = {ScanState::kFailed, outcome.error()};
  } else if (*outcome) {
    end.state = ScanState::kDone;
    surface_ = std::move(*outcome);
  }
  status_.error = end.error;
  // Ignores an error. The state only tells a later process how the scan ended. If it is missing,
  // the scan counts as resumable.
  (void)folder_.write_state(end);
  enter(end.state);
}

// Runs the scan and makes the mesh. Returns null if the scan was interrupted. An exception in this
// thread or in the measuring thread makes the scan fail, but does not end the process.
Expected<std::shared_ptr<const ScannedSurface>> Scan::run_and_mesh() try {
  ScanRun run({.scanner = scanner_,
               .request = request_,
               .folder = folder_,
               .stop = stop_,
               .preview = preview_,
               .watch = *this,
               .retries = settings_.retries});
  if (auto scanned = run.run(); !scanned) return tl::unexpected(scanned.error());
  {
    const std::lock_guard lock(mutex_);
    if (requested_ != RequestedAction::kRun) return nullptr;
    enter(ScanState::kMeshing);
  }
  auto surface = mesh_of(run.take_profiles(), run.calibration(), request_.processing);
  if (!surface) return tl::unexpected(surface.error());
  return std::make_shared<const ScannedSurface>(std::move(*surface));
} catch (const std::exception& fault) {
  return tl::unexpected(error_of(fault));
}

}  // namespace vitrine::acquisition
