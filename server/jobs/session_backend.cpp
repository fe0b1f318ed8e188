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

namespace vitrine {
namespace {

constexpr std::chrono::milliseconds kTick{100};  // how often a scan is asked how far it is
constexpr std::uint64_t kMaxReport = 16 << 20;   // bytes

bool is_under_way(ScanState state) {
  return state == ScanState::kChecking || state == ScanState::kScanning ||
         state == ScanState::kMeshing;
}

// The record is there from the first step on.
ScanTold told_of(const ScanStatus& status, const std::optional<ScanRecord>& record) {
  ScanTold told{.stage = status.state == ScanState::kMeshing ? "meshing" : "scanning",
                .step = status.steps_done,
                .progress = status.progress,
                .eta = status.seconds_left,
                .calibration = 0,
                .rows = std::nullopt,
                .note = status.note};
  if (!record) return told;
  const RowShares rows = shares(status.stripe, record->settings.region.height);
  told.calibration = record->calibration;
  told.rows = {rows.empty, rows.saturated, rows.doubled};
  return told;
}

std::optional<ScanRecord> record_of(const Scan& scan) {
  auto record = scan.folder().record();
  return record ? std::move(*record) : std::nullopt;
}

// What a session shows, and what it showed once it has ended.
class SessionView final : public ScanView {
 public:
  explicit SessionView(std::shared_ptr<const Scan> scan) : scan_(std::move(scan)) {}

  std::shared_ptr<const Frame> frame() const override { return scan_->preview().frame().frame; }
  std::vector<std::array<double, 2>> profile() const override {
    std::vector<std::array<double, 2>> points;
    const Profile profile = scan_->preview().profile();
    for (const ProfilePoint& point : profile.points)
      points.push_back({point.at.rho, point.at.z});
    return points;
  }
  ScanTold told() const override { return told_of(scan_->status(), record_of(*scan_)); }
  std::size_t points() const override { return scan_->preview().cloud_size(); }
  std::vector<std::array<float, 3>> points_from(std::size_t first) const override {
    return scan_->preview().cloud_from(first);
  }

 private:
  const std::shared_ptr<const Scan> scan_;
};

// Waits for the scan and carries words both ways; returns how it ended.
ScanStatus follow(Scan& scan, ScanListener& listener) {
  bool asked = false;
  std::optional<ScanRecord> record;
  for (;;) {
    const ScanStatus status = scan.wait(kTick);
    if (!record && status.steps_done > 0) record = record_of(scan);
    listener.told(told_of(status, record));
    if (!is_under_way(status.state)) return status;
    if (asked || !listener.is_interrupted()) continue;
    // One that meshes by now cannot be paused, and ends by itself.
    asked = (listener.is_cancelled() ? scan.cancel() : scan.pause()).has_value();
  }
}

CalibrationSummary summary_of(const Calibration& calibration) {
  const SensorRegion& region = calibration.region;
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
  if (!bytes) return Unexpected(bytes.error());
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
  // One that was stopped, unplugged or switched off by its watchdog since is opened anew.
  if (board_ && !board_->position()) close();
  if (board_) return {};
  auto board = scanner_.devices.open_board();
  if (!board) return Unexpected(board.error());
  board_ = std::move(*board);
  stop_.guard(board_.get());
  return {};
}

Expected<void> SessionBackend::open_camera() {
  if (camera_) return {};
  auto camera = scanner_.devices.open_camera();
  if (!camera) return Unexpected(camera.error());
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
  if (auto opened = closed_on_error(open()); !opened) return Unexpected(opened.error());
  ScannerIdentity identity{camera_->identity(), board_->identity(), std::nullopt};
  const auto calibration =
      CalibrationStore(config_.calibrations).for_camera(identity.camera.serial, camera_->region());
  if (calibration) identity.calibration = calibration->number;
  return identity;
}

Expected<void> SessionBackend::jog(double degrees) {
  return closed_on_error(open()
                             .and_then([&] { return board_->position(); })
                             .and_then([&](std::optional<double> from) -> Expected<void> {
                               if (!from) {
                                 if (auto told = board_->set_position(0); !told) return told;
                               }
                               return board_->turn_to(from.value_or(0) + degrees);
                             })
                             .and_then([&] { return board_->rest(); }));
}

Expected<void> SessionBackend::laser(bool on) {
  // Off: all of it, so that the watchdog rests.
  return closed_on_error(
      open().and_then([&] { return on ? board_->laser(true) : board_->rest(); }));
}

Expected<Frame> SessionBackend::picture() {
  return closed_on_error(open_camera().and_then([&] { return camera_->capture(); }));
}

Expected<std::shared_ptr<Scan>> SessionBackend::open_scan(const ScanOrder& order,
                                                          const std::filesystem::path& folder) {
  std::error_code error;
  const bool is_begun = std::filesystem::exists(folder / "scan.json", error);
  ScanRequest request = order.request;
  request.calibration = order.calibration;
  auto scan = is_begun ? Scan::reopen(scanner_, folder) : Scan::create(scanner_, request, folder);
  if (!scan) return Unexpected(scan.error());
  return std::shared_ptr<Scan>(std::move(*scan));
}

// From now on the scan's devices are those to be stopped; null: none any more.
void SessionBackend::drive(const std::shared_ptr<Scan>& scan) {
  const std::scoped_lock lock(mutex_);
  scan_ = scan;
}

Expected<std::optional<TriangleMesh>> SessionBackend::scan(const ScanOrder& order,
                                                           const std::filesystem::path& folder,
                                                           ScanListener& listener) {
  close();
  auto scan = open_scan(order, folder);
  if (!scan) return Unexpected(scan.error());
  listener.begins(std::make_shared<SessionView>(*scan));
  if (auto resumed = (*scan)->resume(); !resumed) return Unexpected(resumed.error());
  drive(*scan);
  if (stop_.is_pressed()) (*scan)->emergency_stop();  // it came before the line above
  ScanStatus end;
  try {
    end = follow(**scan, listener);
  } catch (...) {  // the devices are others' from here on
    static_cast<void>((*scan)->pause());
    while (is_under_way((*scan)->wait(kTick).state)) {
    }
    drive(nullptr);
    throw;
  }
  drive(nullptr);
  if (end.state == ScanState::kFailed)
    return fail(end.error ? end.error->code : ErrorCode::kIo, end.error ? end.error->message : "");
  const auto surface = (*scan)->surface();
  return surface ? std::optional(surface->mesh) : std::nullopt;
}

void SessionBackend::emergency_stop() noexcept {
  stop_.press();
  const std::scoped_lock lock(mutex_);
  if (scan_) scan_->emergency_stop();
}

Expected<CalibrationInput> SessionBackend::picture_at_rig(CalibrationListener& listener) {
  auto rig = RigLink::connect(config_.rig);
  if (!rig) return Unexpected(rig.error());
  const auto poses = rig->poses();
  if (!poses) return Unexpected(poses.error());
  const PlaceTarget place = [&](int number) -> Expected<bool> {
    listener.told({.progress = static_cast<double>(number) / *poses});
    if (number >= *poses) return false;
    return rig->place_target(number).map([] { return true; });
  };
  const TargetPictureOptions options{.is_interrupted = [&] { return listener.is_interrupted(); }};
  auto pictures = picture_target(scanner_, config_.target, place, stop_, options);
  const auto restored = rig->place_object();
  if (pictures && !restored) return Unexpected(restored.error());
  return pictures;
}

// Laser and motor are off whenever somebody is asked to come near.
Expected<CalibrationInput> SessionBackend::picture_by_hand(int poses,
                                                           CalibrationListener& listener) {
  CalibrationTold told;
  const PlaceTarget place = [&](int number) -> Expected<bool> {
    told.progress = static_cast<double>(number) / poses;
    told.stage = fmt::format("place the target, pose {} of {}", number + 1, poses);
    if (number < poses && !listener.await_operator(told))
      return fail(ErrorCode::kState, "the calibration was interrupted; start it again");
    told.stage = CalibrationTold{}.stage;
    listener.told(told);
    return number < poses;
  };
  const TargetPictureOptions options{.progress = [&](const std::string& seen) { told.note = seen; },
                                     .is_interrupted = [&] { return listener.is_interrupted(); }};
  return picture_target(scanner_, config_.target, place, stop_, options);
}

Expected<int> SessionBackend::calibrate(const CalibrationOrder& order,
                                        CalibrationListener& listener) {
  close();
  const auto pictures =
      config_.rig.empty() ? picture_by_hand(order.poses, listener) : picture_at_rig(listener);
  if (!pictures) return Unexpected(pictures.error());
  const auto calibrated = vitrine::calibrate(*pictures, {});
  if (!calibrated) return Unexpected(calibrated.error());
  return keep_calibration(config_.calibrations, *calibrated).map([](const Calibration& stored) {
    return stored.number;
  });
}

Expected<TriangleMesh> SessionBackend::mesh_anew(const ScanOrder& order,
                                                 const std::filesystem::path& folder) {
  const auto scan = ScanFolder::open(folder);
  if (!scan) return Unexpected(scan.error());
  auto surface =
      reprocess(*scan, config_.calibrations,
                {.processing = order.request.processing, .calibration = order.calibration});
  if (!surface) return Unexpected(surface.error());
  return std::move(surface->mesh);
}

Expected<std::shared_ptr<const ScanView>> SessionBackend::view(
    const std::filesystem::path& folder) {
  auto scan = Scan::reopen(scanner_, folder);
  if (!scan) return Unexpected(scan.error());
  return std::make_shared<SessionView>(std::shared_ptr<const Scan>(std::move(*scan)));
}

Expected<std::vector<CalibrationSummary>> SessionBackend::calibrations() {
  const CalibrationStore store(config_.calibrations);
  auto numbers = store.numbers();
  if (!numbers) return Unexpected(numbers.error());
  std::vector<CalibrationSummary> all;
  for (auto number = numbers->rbegin(); number != numbers->rend(); ++number) {
    const auto calibration = store.load(*number);
    all.push_back(calibration ? summary_of(*calibration)
                              : CalibrationSummary{*number, calibration.error().message});
  }
  return all;
}

// One that was made elsewhere may have no report: then it is itself what is known of it.
Expected<std::optional<std::string>> SessionBackend::calibration_report(int number) {
  auto report = text_of(report_file(config_.calibrations, number));
  if (!report || *report) return report;
  return text_of(config_.calibrations / fmt::format("{:04}.json", number));
}

Expected<std::optional<std::string>> SessionBackend::residual_plot(int number) {
  return text_of(residuals_file(config_.calibrations, number));
}

}  // namespace vitrine
