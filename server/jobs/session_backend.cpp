// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/session_backend.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "acquisition/calibration/calibration_store.h"
#include "acquisition/calibration/keep_calibration.h"
#include "acquisition/session/reprocess.h"
#include "acquisition/session/rig_link.h"
#include "acquisition/session/target_pictures.h"
#include "codec/files/read_file.h"

namespace vitrine::server {
namespace {

// Interval at which a running scan's progress is read.
constexpr std::chrono::milliseconds kTick{100};
constexpr std::uint64_t kMaxReport = 16 << 20;  // largest report or plot, in bytes

bool is_under_way(acquisition::ScanState state) {
  return state == acquisition::ScanState::kChecking || state == acquisition::ScanState::kScanning ||
         state == acquisition::ScanState::kMeshing;
}

// Returns the progress of a scan. `record` is nullopt until the first step.
ScanProgress progress_of(const acquisition::ScanStatus& status,
                         const std::optional<acquisition::ScanRecord>& record) {
  ScanProgress progress{
      .stage = status.state == acquisition::ScanState::kMeshing ? "meshing" : "scanning",
      .step = status.steps_done,
      .progress = status.progress,
      .eta = status.seconds_left,
      .calibration = 0,
      .rows = std::nullopt,
      .note = status.note};
  if (!record) return progress;
  const acquisition::RowShares rows = shares(status.stripe, record->settings.region.height);
  progress.calibration = record->calibration;
  progress.rows = {rows.empty, rows.saturated, rows.doubled};
  return progress;
}

std::optional<acquisition::ScanRecord> record_of(const acquisition::Scan& scan) {
  auto record = scan.folder().record();
  return record ? std::move(*record) : std::nullopt;
}

// The view of a scan in this process, while it runs and after it has ended.
class SessionView final : public ScanView {
 public:
  explicit SessionView(std::shared_ptr<const acquisition::Scan> scan) : scan_(std::move(scan)) {}

  std::shared_ptr<const acquisition::Frame> frame() const override {
    return scan_->preview().frame().frame;
  }
  std::vector<std::array<double, 2>> profile() const override {
    std::vector<std::array<double, 2>> points;
    const acquisition::Profile profile = scan_->preview().profile();
    for (const acquisition::ProfilePoint& point : profile.points)
      points.push_back({point.at.rho, point.at.z});
    return points;
  }
  ScanProgress progress() const override { return progress_of(scan_->status(), record_of(*scan_)); }
  std::size_t points() const override { return scan_->preview().cloud_size(); }
  std::vector<std::array<float, 3>> points_from(std::size_t first) const override {
    return scan_->preview().cloud_from(first);
  }

 private:
  const std::shared_ptr<const acquisition::Scan> scan_;
};

// Waits for the end of the scan, reports its progress, and pauses or cancels it if the listener
// demands this. Returns the scan's final status.
acquisition::ScanStatus follow(acquisition::Scan& scan, ScanListener& listener) {
  bool asked = false;
  std::optional<acquisition::ScanRecord> record;
  for (;;) {
    const acquisition::ScanStatus status = scan.wait(kTick);
    if (!record && status.steps_done > 0) record = record_of(scan);
    listener.report(progress_of(status, record));
    if (!is_under_way(status.state)) return status;
    if (asked || !listener.is_interrupted()) continue;
    // A scan that is already being meshed cannot be paused, but it ends by itself.
    asked = (listener.is_cancelled() ? scan.cancel() : scan.pause()).has_value();
  }
}

CalibrationSummary summary_of(const acquisition::Calibration& calibration) {
  const acquisition::SensorRegion& region = calibration.region;
  return {.number = calibration.number,
          .problem = {},
          .created = calibration.created,
          .camera = calibration.camera,
          .region = region,
          .rms = calibration.residuals.rms,
          .p95 = calibration.residuals.p95,
          .max = calibration.residuals.max,
          .coverage = calibration.map.image_share(region.width, region.height)};
}

Expected<std::optional<std::string>> text_of(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return std::nullopt;
  const auto bytes = read_file(file, kMaxReport);
  if (!bytes) return tl::unexpected(bytes.error());
  return std::string(bytes->begin(), bytes->end());
}

}  // namespace

Expected<void> SessionBackend::open() {
  return open_board().and_then([this] { return open_camera(); });
}

Expected<void> SessionBackend::open_board() {
  if (stop_.is_pressed()) {
    return fail(ErrorCode::kState,
                fmt::format("scanner {} was stopped; give it another command", config_.name));
  }
  // Closes a board that was stopped, unplugged or switched off by its watchdog since the last
  // command, so that it is opened again.
  if (board_ && !board_->position()) close();
  if (board_) return {};
  auto board = scanner_.devices.open_board();
  if (!board) return tl::unexpected(board.error());
  board_ = std::move(*board);
  stop_.guard(board_.get());
  return {};
}

Expected<void> SessionBackend::open_camera() {
  if (camera_) return {};
  auto camera = scanner_.devices.open_camera();
  if (!camera) return tl::unexpected(camera.error());
  camera_ = std::move(*camera);
  return camera_->configure(scanner_.settings);
}

void SessionBackend::close() {
  stop_.guard(nullptr);
  camera_.reset();
  board_.reset();
}

template <class T>
Expected<T> SessionBackend::closed_on_error(Expected<T> result) {
  if (!result) close();
  return result;
}

Expected<ScannerIdentity> SessionBackend::identify() {
  if (auto opened = closed_on_error(open()); !opened) return tl::unexpected(opened.error());
  ScannerIdentity identity{camera_->identity(), board_->identity(), std::nullopt};
  const auto calibration = acquisition::CalibrationStore(config_.calibrations)
                               .for_camera(identity.camera.serial, camera_->region());
  if (calibration) identity.calibration = calibration->number;
  return identity;
}

Expected<void> SessionBackend::jog(double degrees) {
  return closed_on_error(open()
                             .and_then([&] { return board_->position(); })
                             .and_then([&](std::optional<double> from) -> Expected<void> {
                               if (!from) {
                                 if (auto set = board_->set_position(0); !set) return set;
                               }
                               return board_->turn_to(from.value_or(0) + degrees);
                             })
                             .and_then([&] { return board_->rest(); }));
}

Expected<void> SessionBackend::laser(bool on) {
  // Switches the laser off with rest(), which also pauses the board's watchdog. Otherwise, the
  // watchdog would trigger, because no further command follows.
  return closed_on_error(
      open().and_then([&] { return on ? board_->laser(true) : board_->rest(); }));
}

Expected<void> SessionBackend::keep_laser() {
  if (!board_) return fail(ErrorCode::kState, "the laser is off; switch it on again");
  const auto position = closed_on_error(board_->position());
  return position ? Expected<void>() : tl::unexpected(position.error());
}

Expected<acquisition::Frame> SessionBackend::picture() {
  return closed_on_error(open_camera().and_then([&] { return camera_->capture(); }));
}

Expected<std::shared_ptr<acquisition::Scan>> SessionBackend::open_scan(
    const ScanOrder& order, const std::filesystem::path& folder) {
  std::error_code error;
  const bool is_begun = std::filesystem::exists(folder / "scan.json", error);
  acquisition::ScanRequest request = order.request;
  request.calibration = order.calibration;
  auto scan = is_begun ? acquisition::Scan::reopen(scanner_, folder)
                       : acquisition::Scan::create(scanner_, request, folder);
  if (!scan) return tl::unexpected(scan.error());
  return std::shared_ptr<acquisition::Scan>(std::move(*scan));
}

// Records the running scan, or null, so that an emergency stop can switch off the scan's devices.
void SessionBackend::drive(const std::shared_ptr<acquisition::Scan>& scan) {
  const std::scoped_lock lock(mutex_);
  scan_ = scan;
}

Expected<std::optional<TriangleMesh>> SessionBackend::scan(const ScanOrder& order,
                                                           const std::filesystem::path& folder,
                                                           ScanListener& listener) {
  close();
  auto scan = open_scan(order, folder);
  if (!scan) return tl::unexpected(scan.error());
  listener.begins(std::make_shared<SessionView>(*scan));
  if (auto resumed = (*scan)->resume(); !resumed) return tl::unexpected(resumed.error());
  drive(*scan);
  if (stop_.is_pressed())
    (*scan)->emergency_stop();  // repeats an emergency stop that came before drive()
  acquisition::ScanStatus end;
  try {
    end = follow(**scan, listener);
  } catch (...) {  // ends the scan, so that other programs can open its devices
    static_cast<void>((*scan)->pause());
    while (is_under_way((*scan)->wait(kTick).state)) {
    }
    drive(nullptr);
    throw;
  }
  drive(nullptr);
  if (end.state == acquisition::ScanState::kFailed)
    return fail(end.error ? end.error->code : ErrorCode::kIo, end.error ? end.error->message : "");
  const auto surface = (*scan)->surface();
  return surface ? std::optional(surface->mesh) : std::nullopt;
}

void SessionBackend::emergency_stop() noexcept {
  stop_.press();
  const std::scoped_lock lock(mutex_);
  if (scan_) scan_->emergency_stop();
}

Expected<acquisition::CalibrationInput> SessionBackend::picture_at_rig(
    CalibrationListener& listener) {
  auto rig = acquisition::RigLink::connect(config_.rig);
  if (!rig) return tl::unexpected(rig.error());
  const auto poses = rig->poses();
  if (!poses) return tl::unexpected(poses.error());
  const acquisition::PlaceTarget place = [&](int number) -> Expected<bool> {
    listener.report({.progress = static_cast<double>(number) / *poses});
    if (number >= *poses) return false;
    return rig->place_target(number).map([] { return true; });
  };
  const acquisition::TargetPictureOptions options{
      .is_interrupted = [&] { return listener.is_interrupted(); }};
  auto pictures = picture_target(scanner_, config_.target, place, stop_, options);
  const auto restored = rig->place_object();
  if (pictures && !restored) return tl::unexpected(restored.error());
  return pictures;
}

// Takes the calibration pictures. Laser and motor are off while the operator places the target.
Expected<acquisition::CalibrationInput> SessionBackend::picture_by_hand(
    int poses, CalibrationListener& listener) {
  CalibrationProgress progress;
  const acquisition::PlaceTarget place = [&](int number) -> Expected<bool> {
    progress.progress = static_cast<double>(number) / poses;
    progress.stage = fmt::format("place the target, pose {} of {}", number + 1, poses);
    if (number < poses && !listener.await_operator(progress))
      return fail(ErrorCode::kState, "the calibration was interrupted; start it again");
    progress.stage = CalibrationProgress{}.stage;
    listener.report(progress);
    return number < poses;
  };
  const acquisition::TargetPictureOptions options{
      .progress = [&](const std::string& seen) { progress.note = seen; },
      .is_interrupted = [&] { return listener.is_interrupted(); }};
  return picture_target(scanner_, config_.target, place, stop_, options);
}

Expected<int> SessionBackend::calibrate(const CalibrationOrder& order,
                                        CalibrationListener& listener) {
  close();
  const auto pictures =
      config_.rig.empty() ? picture_by_hand(order.poses, listener) : picture_at_rig(listener);
  if (!pictures) return tl::unexpected(pictures.error());
  const auto calibrated = vitrine::acquisition::calibrate(*pictures, {});
  if (!calibrated) return tl::unexpected(calibrated.error());
  return acquisition::keep_calibration(config_.calibrations, *calibrated)
      .map([](const acquisition::Calibration& stored) { return stored.number; });
}

Expected<TriangleMesh> SessionBackend::rebuild_mesh(const ScanOrder& order,
                                                    const std::filesystem::path& folder) {
  const auto scan = acquisition::ScanFolder::open(folder);
  if (!scan) return tl::unexpected(scan.error());
  auto surface =
      reprocess(*scan, config_.calibrations,
                {.processing = order.request.processing, .calibration = order.calibration});
  if (!surface) return tl::unexpected(surface.error());
  return std::move(surface->mesh);
}

Expected<std::shared_ptr<const ScanView>> SessionBackend::view(
    const std::filesystem::path& folder) {
  auto scan = acquisition::Scan::reopen(scanner_, folder);
  if (!scan) return tl::unexpected(scan.error());
  return std::make_shared<SessionView>(std::shared_ptr<const acquisition::Scan>(std::move(*scan)));
}

Expected<std::vector<CalibrationSummary>> SessionBackend::calibrations() {
  const acquisition::CalibrationStore store(config_.calibrations);
  auto numbers = store.numbers();
  if (!numbers) return tl::unexpected(numbers.error());
  std::vector<CalibrationSummary> all;
  for (auto number = numbers->rbegin(); number != numbers->rend(); ++number) {
    const auto calibration = store.load(*number);
    all.push_back(calibration ? summary_of(*calibration)
                              : CalibrationSummary{.number = *number,
                                                   .problem = calibration.error().message});
  }
  return all;
}

// Returns the report of a calibration. If there is no report because another program made the
// calibration, returns the calibration file itself.
Expected<std::optional<std::string>> SessionBackend::calibration_report(int number) {
  auto report = text_of(acquisition::report_file(config_.calibrations, number));
  if (!report || *report) return report;
  return text_of(config_.calibrations / fmt::format("{:04}.json", number));
}

Expected<std::optional<std::string>> SessionBackend::residual_plot(int number) {
  return text_of(acquisition::residuals_file(config_.calibrations, number));
}

}  // namespace vitrine::server
