// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/scan_service.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "acquisition/session/reprocess.h"
#include "codec/export/write_mesh.h"
#include "server/catalogue/private_file.h"
#include "server/jobs/clock.h"
#include "server/jobs/job_claim.h"
#include "server/jobs/retry_while_unreachable.h"
#include "server/jobs/revolution.h"
#include "server/store/published_model.h"

namespace vitrine::server {
namespace {

constexpr double kMeshed = 0.85, kBuilt = 0.99;  // progress after meshing and after building
constexpr std::chrono::seconds kLaserWatch{1};   // interval of watch_manual_laser()
constexpr std::size_t kViews = 4;                // largest number of views of ended scans in memory

JobRecord new_job(JobKind kind, const std::string& scanner) {
  JobRecord job;
  job.id = JobId::generate();
  job.kind = kind;
  job.scanner = scanner;
  job.created = now_in_milliseconds();
  return job;
}

Expected<void> check_calibrated(ScannerBackend& scanner) {
  const auto all = scanner.calibrations();
  if (!all) return tl::unexpected(all.error());
  if (std::ranges::any_of(*all, [](const auto& one) { return one.problem.empty(); })) return {};
  return fail(ErrorCode::kState, fmt::format("scanner {0} has no calibration; POST "
                                             "/api/v1/scanners/{0}/calibrations first",
                                             scanner.name()));
}

}  // namespace

// Passes the progress of a scan on to its job, its row in the catalogue and the list of running
// scans.
class ScanService::Listener final : public ScanListener {
 public:
  Listener(ScanService& service, JobRun& run, ScanEntry entry)
      : service_(service), run_(run), entry_(std::move(entry)) {}
  ~Listener() override {
    const std::scoped_lock lock(service_.mutex_);
    service_.live_.erase(entry_.id);
  }

  void begins(std::shared_ptr<const ScanView> view) override {
    const std::scoped_lock lock(service_.mutex_);
    service_.views_.erase(entry_.id);
    view_ = std::move(view);
    service_.live_[entry_.id] = {entry_, view_};
  }

  void report(const ScanProgress& progress) override {
    const bool calibration_is_new =
        entry_.calibration != progress.calibration && progress.calibration > 0;
    entry_.step = progress.step;
    if (calibration_is_new) entry_.calibration = progress.calibration;
    if (progress.rows) entry_.rows = progress.rows;
    if (view_) entry_.points = view_->points();
    {
      const std::scoped_lock lock(service_.mutex_);
      service_.live_[entry_.id] = {entry_, view_};
    }
    run_.report(progress.stage, kMeshed * progress.progress, progress.eta, progress.note);
    if (calibration_is_new) keep();
  }

  bool is_interrupted() const override { return run_.stop_request() != StopRequest::kNone; }
  bool is_cancelled() const override { return run_.stop_request() == StopRequest::kCancel; }

  void keep() { service_.keep(entry_, run_.job()); }

 private:
  ScanService& service_;
  JobRun& run_;
  ScanEntry entry_;
  std::shared_ptr<const ScanView> view_;
};

ScanService::ScanService(const ScanServiceOptions& options,
                         std::vector<std::unique_ptr<ScannerBackend>> scanners)
    : options_(options),
      backends_(std::move(scanners)),
      queue_(
          options.jobs, options.events, [this](JobRun& run) { return work(run); }, options.taken) {
  for (const auto& backend : backends_)
    stations_.push_back(
        std::make_unique<ScannerStation>(*backend, queue_, options.idle_timeout, options.now));
}

Expected<void> ScanService::start() {
  std::error_code error;
  const std::filesystem::path scans = options_.data / "scans";
  create_private_folder(scans, error);
  if (error) {
    return fail(ErrorCode::kIo,
                fmt::format("cannot make the folder {}: {}; check its owner and mode",
                            scans.string(), error.message()));
  }
  sweep_removed_revolutions(scans);
  if (auto recalled = recall(); !recalled) return recalled;
  for (const auto& station : stations_)
    station->look_for_it();
  laser_watch_.emplace(kLaserWatch, options_.events, [this] {
    for (const auto& station : stations_)
      station->watch_manual_laser();
  });
  return queue_.start();
}

// Reads the number of steps of each scan from its folder, because the catalogue is updated only
// every few steps and may be outdated after a crash.
Expected<void> ScanService::recall() {
  const auto left = options_.jobs.unfinished_jobs();
  if (!left) return tl::unexpected(left.error());
  for (const JobRecord& job : *left) {
    if (job.kind == JobKind::kScan && job.scan && options_.taken.has(job)) recall(job);
  }
  return {};
}

// Ignores a scan that cannot be read: the scan's job will report the error when it runs.
void ScanService::recall(JobRecord job) {
  ScannerStation* station = scanner(job.scanner);
  auto entry = options_.jobs.find_scan(*job.scan);
  if (station == nullptr || !entry || !*entry) return;
  if (!holds_revolution(folder_of(*job.scan), (*entry)->revolution).value_or(false)) return;
  const auto view = station->backend().view(folder_of(*job.scan));
  if (!view || *view == nullptr) return;
  const ScanProgress progress = (*view)->progress();
  (*entry)->step = std::max((*entry)->step, progress.step);
  (*entry)->points = (*view)->points();
  if (progress.calibration > 0) (*entry)->calibration = progress.calibration;
  if (progress.rows) (*entry)->rows = progress.rows;
  keep(**entry, job);
  job.progress = std::max(job.progress, kMeshed * progress.progress);
  if (auto kept = options_.jobs.update(job); !kept)
    options_.events.event(Severity::kError, kept.error().message);
}

void ScanService::stop() {
  const std::scoped_lock one(stopping_);
  laser_watch_.reset();
  for (const auto& station : stations_)
    station->close_after_all();
  queue_.stop();
}

std::vector<ScannerStatus> ScanService::scanners() {
  std::vector<ScannerStatus> all;
  for (const auto& station : stations_)
    all.push_back(station->status());
  return all;
}

std::vector<std::string> ScanService::names() const {
  std::vector<std::string> names;
  for (const auto& station : stations_)
    names.push_back(station->name());
  return names;
}

std::optional<std::string> ScanService::address_of(const std::string& name) const {
  return options_.claims == nullptr ? std::nullopt : options_.claims->address_of(name);
}

std::map<std::string, std::vector<std::string>> ScanService::others() const {
  if (options_.claims == nullptr) return {};
  return options_.claims->others();
}

ScannerStation* ScanService::scanner(std::string_view name) {
  const auto found =
      std::ranges::find_if(stations_, [&](const auto& station) { return station->name() == name; });
  return found == stations_.end() ? nullptr : found->get();
}

Expected<acquisition::Frame> ScanService::picture(ScannerStation& scanner) {
  const auto job = queue_.job_of(scanner.name());
  const bool scans = job && job->record.scan && job->record.state != JobState::kPaused;
  if (!scans) return scanner.picture();
  std::shared_ptr<const ScanView> view;
  {
    const std::scoped_lock lock(mutex_);
    const auto live = live_.find(*job->record.scan);
    if (live != live_.end()) view = live->second.view;
  }
  if (const auto frame = view ? view->frame() : nullptr) return *frame;
  return fail(ErrorCode::kState, "the scan has taken no picture yet; ask again in a second");
}

Expected<JobRecord> ScanService::calibrate(ScannerStation& scanner, const CalibrationOrder& order,
                                           const std::optional<IdempotencyKey>& key) {
  JobRecord job = new_job(JobKind::kCalibrate, scanner.name());
  job.parameters = to_json_text(order);
  job.webhook = order.webhook;
  return queue_.add(job, std::nullopt, key, scanner.backend().stops());
}

Expected<ScanStarted> ScanService::add(JobRecord job, ScanEntry scan,
                                       const std::optional<IdempotencyKey>& key) {
  job.scan = scan.id;
  scan.job = job.id;
  const auto added = queue_.add(job, scan, key, stops_of(job.scanner));
  if (!added) return tl::unexpected(added.error());
  return ScanStarted{added->scan.value_or(scan.id), added->id};
}

Expected<ScanStarted> ScanService::scan(const ScanOrder& order,
                                        const std::optional<IdempotencyKey>& key) {
  const auto begun = queue_.begun_by(key);
  if (!begun) return tl::unexpected(begun.error());
  if (*begun) return ScanStarted{(*begun)->scan.value_or(ScanId()), (*begun)->id};
  auto calibrated = check_calibrated(scanner(order.scanner)->backend());
  if (!calibrated) return tl::unexpected(calibrated.error());
  JobRecord job = new_job(JobKind::kScan, order.scanner);
  job.webhook = order.webhook;
  return add(std::move(job), new_scan(order), key);
}

Expected<ScanStarted> ScanService::reprocess(const ScanEntry& scan, const ScanOrder& order,
                                             const std::optional<IdempotencyKey>& key,
                                             const std::optional<TokenId>& owner) {
  const auto begun = queue_.begun_by(key);
  if (!begun) return tl::unexpected(begun.error());
  if (*begun) return ScanStarted{scan.id, (*begun)->id};
  if (auto unused = check_unused(scan); !unused) return tl::unexpected(unused.error());
  if (scan.step == 0)
    return fail(ErrorCode::kState, "the scan has no steps to make a model of; resume it first");
  if (auto here = check_revolution(scan); !here) return tl::unexpected(here.error());
  const auto ordered = order_of(scan);
  if (!ordered) return tl::unexpected(ordered.error());
  ScanOrder whole = order;
  if (whole.calibration == 0) whole.calibration = scan.calibration;
  const acquisition::ReprocessOptions options{.processing = whole.request.processing,
                                              .calibration = whole.calibration};
  if (auto kept = check_pictures(ordered->request, scan.calibration, options); !kept)
    return tl::unexpected(kept.error());
  JobRecord job = new_job(JobKind::kReprocess, scan.scanner);
  job.scan = scan.id;
  job.parameters = to_json_text(whole);
  job.webhook = whole.webhook;
  if (owner) job.owner = owner->to_string();
  const auto added = queue_.add(job, std::nullopt, key);
  if (!added) return tl::unexpected(added.error());
  return ScanStarted{scan.id, added->id};
}

Expected<void> ScanService::check_unused(const ScanEntry& scan) {
  const auto job = queue_.job_where([&](const JobRecord& one) { return one.scan == scan.id; });
  if (!job) return tl::unexpected(job.error());
  if (!*job) return {};
  return fail(ErrorCode::kState,
              fmt::format("job {} works on the scan; wait for its end", (*job)->id.to_string()));
}

Expected<void> ScanService::remove_data(const ScanEntry& scan) {
  if (auto unused = check_unused(scan); !unused) return unused;
  if (auto here = check_revolution(scan); !here) return here;
  auto removed = remove_revolution(folder_of(scan.id));
  const std::scoped_lock lock(mutex_);
  views_.erase(scan.id);
  return removed;
}

Expected<void> ScanService::pause(const ScanEntry& scan) {
  const auto paused = queue_.pause(scan.job);
  return paused ? Expected<void>{} : tl::unexpected(paused.error());
}

Expected<void> ScanService::resume(const ScanEntry& scan) {
  const auto job = queue_.find(scan.job);
  if (!job) return tl::unexpected(job.error());
  if (*job && (*job)->record.state == JobState::kFailed) {
    if (auto unused = check_unused(scan); !unused) return unused;
    JobRecord next = new_job(JobKind::kScan, scan.scanner);
    next.progress = (*job)->record.progress;
    next.webhook = (*job)->record.webhook;
    const auto added = add(next, scan, std::nullopt);
    return added ? Expected<void>{} : tl::unexpected(added.error());
  }
  const auto resumed = queue_.resume(scan.job, stops_of(scan.scanner));
  return resumed ? Expected<void>{} : tl::unexpected(resumed.error());
}

Expected<JobStatus> ScanService::resume(const JobRecord& job) {
  return queue_.resume(job.id, stops_of(job.scanner));
}

Expected<ScanInfo> ScanService::with_job(ScanEntry entry) {
  {
    const std::scoped_lock lock(mutex_);
    if (const auto live = live_.find(entry.id); live != live_.end()) entry = live->second.entry;
  }
  const auto job = queue_.find(entry.job);
  if (!job) return tl::unexpected(job.error());
  return ScanInfo{std::move(entry), job->value_or(JobStatus{})};
}

Expected<std::optional<ScanInfo>> ScanService::find(const ScanId& id) {
  const auto entry = options_.jobs.find_scan(id);
  if (!entry) return tl::unexpected(entry.error());
  if (!*entry) return std::nullopt;
  return with_job(**entry);
}

Expected<std::vector<ScanInfo>> ScanService::list(const PageOf<ScanId>& page) {
  const auto entries = options_.jobs.scans(page);
  if (!entries) return tl::unexpected(entries.error());
  std::vector<ScanInfo> scans;
  for (const ScanEntry& entry : *entries) {
    auto status = with_job(entry);
    if (!status) return tl::unexpected(status.error());
    scans.push_back(std::move(*status));
  }
  return scans;
}

Expected<ScanOrder> ScanService::order_of(const ScanEntry& scan) {
  return stored_scan_order(scan.parameters);
}

Expected<std::shared_ptr<const ScanView>> ScanService::view(const ScanEntry& scan) {
  {
    const std::scoped_lock lock(mutex_);
    if (const auto live = live_.find(scan.id); live != live_.end()) return live->second.view;
    if (const auto kept = views_.find(scan.id); kept != views_.end()) return kept->second;
  }
  ScannerStation* station = scanner(scan.scanner);
  if (station == nullptr || scan.step == 0) return nullptr;
  if (auto here = check_revolution(scan); !here) return tl::unexpected(here.error());
  auto view = station->backend().view(folder_of(scan.id));
  if (!view) return view;
  const std::scoped_lock lock(mutex_);
  // Checks the revolution again while it holds mutex_. remove_data() deletes the revolution first
  // and acquires mutex_ afterwards, so the check above may be outdated.
  if (auto here = check_revolution(scan); !here) return tl::unexpected(here.error());
  if (views_.size() >= kViews) views_.erase(views_.begin());
  views_[scan.id] = *view;
  return view;
}

Expected<void> ScanService::check_revolution(const ScanEntry& scan) const {
  const auto is_here = holds_revolution(folder_of(scan.id), scan.revolution);
  if (!is_here) return tl::unexpected(is_here.error());
  if (*is_here) return {};
  return fail(
      ErrorCode::kState,
      fmt::format(
          "the folder scans/{} was deleted from the data folder, or another daemon measured "
          "the scan into its own; let that daemon drive the scanner, restore the "
          "folder from a backup, or scan again",
          scan.id.to_string()));
}

// Ensures that this daemon's data folder contains the steps of the scan's current revolution. If
// another daemon measured these steps, they are in that daemon's folder. In this case, the scan
// restarts with a new revolution, because the table has moved since.
Expected<void> ScanService::settle_revolution(JobRun& run, ScanEntry& scan) {
  const std::filesystem::path folder = folder_of(scan.id);
  const auto is_here = holds_revolution(folder, scan.revolution);
  // If the folder cannot be read, does not restart the scan, because the folder may contain steps.
  if (!is_here) return tl::unexpected(is_here.error());
  if (*is_here) return {};
  if (scan.step > 0) {
    options_.events.event(Severity::kWarning,
                          fmt::format("scan {} restarts: another daemon measured its {} steps",
                                      scan.id.to_string(), scan.step));
  }
  scan.revolution = to_string(generate_ulid());
  scan.step = 0;
  scan.points = 0;
  scan.rows.reset();
  run.restart();
  const auto kept =
      retry_while_unreachable(run, [&] { return options_.jobs.update(scan, claim_of(run.job())); });
  return kept ? begin_revolution(folder, scan.revolution) : kept;
}

std::filesystem::path ScanService::folder_of(const ScanId& id) const {
  return options_.data / "scans" / id.to_string();
}

std::uint64_t ScanService::stops_of(const std::string& name) {
  ScannerStation* station = scanner(name);
  return station == nullptr ? 0 : station->backend().stops();
}

void ScanService::keep(const ScanEntry& entry, const JobRecord& by) {
  const auto kept = options_.jobs.update(entry, claim_of(by));
  if (!kept) options_.events.event(Severity::kError, kept.error().message);
}

Expected<JobEnd> ScanService::work(JobRun& run) {
  auto end = work_on_kind(run);
  const auto model = run.job().model;
  if (end && model) tell_added(*model);
  return end;
}

// Calls `when_added`. The model is in the catalogue already, so an exception, such as
// std::bad_alloc, does not fail the job.
void ScanService::tell_added(const ModelId& model) {
  if (!options_.when_added) return;
  try {
    options_.when_added(model);
  } catch (const std::exception& fault) {
    options_.events.event(
        Severity::kError,
        fmt::format("model {} was added, but a later step failed: {}; the model is complete",
                    model.to_string(), fault.what()));
  }
}

Expected<JobEnd> ScanService::work_on_kind(JobRun& run) {
  const JobRecord job = run.job();
  if (job.kind == JobKind::kPublish) return options_.publishing(run);
  ScannerStation* station = scanner(job.scanner);
  if (station == nullptr) {
    return fail(ErrorCode::kState,
                fmt::format("there is no scanner {}; name its rig.json in the setting scanners",
                            job.scanner));
  }
  station->switch_manual_laser_off();
  if (job.kind == JobKind::kReprocess) return reprocess(run, *station);
  station->backend().allow(run.stops_known());
  auto end = job.kind == JobKind::kScan ? work_on_scan(run, *station) : calibrate(run, *station);
  if (!queue_.is_stopping()) station->look();  // devices may have been connected or unplugged
  return end;
}

Expected<ScanEntry> ScanService::scan_of(const JobRun& run) {
  auto scan = retry_while_unreachable(
      run, [&] { return options_.jobs.find_scan(run.job().scan.value_or(ScanId())); });
  if (!scan) return tl::unexpected(scan.error());
  if (!*scan) return fail(ErrorCode::kState, "the scan is not in the catalogue; scan again");
  return **scan;
}

Expected<JobEnd> ScanService::work_on_scan(JobRun& run, ScannerStation& station) {
  auto scan = scan_of(run);
  if (!scan) return tl::unexpected(scan.error());
  const auto order = stored_scan_order(scan->parameters);
  if (!order) return tl::unexpected(order.error());
  if (auto settled = settle_revolution(run, *scan); !settled)
    return tl::unexpected(settled.error());
  Expected<std::optional<TriangleMesh>> mesh;
  {
    Listener listener(*this, run, *scan);
    run.report("scanning", 0);
    mesh = station.backend().scan(*order, folder_of(scan->id), listener);
    listener.keep();
  }
  if (!mesh) return tl::unexpected(mesh.error());
  return *mesh ? make_model(run, *order, **mesh) : JobEnd::kPutAside;
}

Expected<JobEnd> ScanService::reprocess(JobRun& run, ScannerStation& station) {
  const auto order = stored_scan_order(run.job().parameters);
  if (!order) return tl::unexpected(order.error());
  // Checks that this daemon has the scan's steps. They are missing if the request came to the wrong
  // daemon, or if another daemon has measured the scan again.
  const auto scan = scan_of(run);
  if (!scan) return tl::unexpected(scan.error());
  if (auto here = check_revolution(*scan); !here) return tl::unexpected(here.error());
  run.report("meshing", 0);
  const auto mesh = station.backend().rebuild_mesh(*order, folder_of(scan->id));
  if (!mesh) return tl::unexpected(mesh.error());
  return make_model(run, *order, *mesh);
}

Expected<JobEnd> ScanService::calibrate(JobRun& run, ScannerStation& station) {
  class Progress final : public CalibrationListener {
   public:
    explicit Progress(JobRun& r) : run_(r) {}
    void report(const CalibrationProgress& progress) override {
      run_.report(progress.stage, progress.progress, std::nullopt, progress.note);
    }
    bool await_operator(const CalibrationProgress& progress) override {
      return run_.await_resume(progress.stage, progress.progress, progress.note);
    }
    bool is_interrupted() const override { return run_.stop_request() != StopRequest::kNone; }

   private:
    JobRun& run_;
  };
  Progress progress(run);
  progress.report({});
  const auto number =
      station.backend().calibrate(stored_calibration_order(run.job().parameters), progress);
  return number ? Expected<JobEnd>(JobEnd::kDone) : tl::unexpected(number.error());
}

Expected<JobEnd> ScanService::make_model(JobRun& run, const ScanOrder& order,
                                         const TriangleMesh& mesh) {
  run.report("building", kMeshed);
  const auto file = write_mesh(mesh, MeshFormat::kPly, {.unit = "mm", .normals = Normals::kNone});
  if (!file) return tl::unexpected(file.error());
  BuildChild child;
  const Reaction stop(run, [&child] { child.stop(); });
  const BuildOrder build{.bits = order.bits,
                         .placement = order.placement,
                         .z_is_up = true,
                         .folder = options_.data,
                         .disk_reserve = options_.disk_reserve(),
                         .program = options_.program};
  const auto built = child.build(*file, build, [&](std::string_view, double done) {
    run.report("building", std::lerp(kMeshed, kBuilt, done));
  });
  if (!built) return tl::unexpected(built.error());
  run.repaired(built->repairs);
  const auto manifest = parse_header(built->file);
  if (!manifest) return tl::unexpected(manifest.error());
  const auto added = add_model(run, order, *built);
  if (!added) return tl::unexpected(added.error());
  const BuiltModel model{added->model, geometry_hash(*manifest)};
  return retry_while_unreachable(run, [&] { return show(run, added->is_public, model); }).map([] {
    return JobEnd::kDone;
  });
}

// Adds the job's model to the catalogue, and publishes it if it may be public.
Expected<ScanService::AddedModel> ScanService::add_model(JobRun& run, const ScanOrder& order,
                                                         const ChildResult& built) {
  auto is_public = retry_while_unreachable(run, [&] { return may_be_public(run, order); });
  if (!is_public) return tl::unexpected(is_public.error());
  const auto model = retry_while_unreachable(run, [&] {
    return publish(options_.store, options_.catalogue, built.file, order.metadata,
                   {.state = *is_public ? ModelState::kPublished : ModelState::kDraft,
                    .id = model_id_of(run.job()),
                    .quota = options_.quota,
                    .by = claim_of(run.job()),
                    .repairs = built.repairs});
  });
  if (!model) return tl::unexpected(model.error());
  run.made(model->id);
  // A model that is not new may come from an earlier, interrupted run of this job.
  if (model->id == model_id_of(run.job()) && (*is_public || !model->is_new))
    is_public = retry_while_unreachable(run, [&] { return stay_public(run, order, model->id); });
  if (!is_public) return tl::unexpected(is_public.error());
  return AddedModel{model->id, *is_public};
}

// Checks again whether the job's new model may be public, because storing its file takes long. If
// it may not, makes the model a draft and returns false.
Expected<bool> ScanService::stay_public(const JobRun& run, const ScanOrder& order,
                                        const ModelId& model) {
  auto may = may_be_public(run, order);
  if (!may || *may) return may;
  const auto hidden = options_.catalogue.set_state(model, ModelState::kDraft);
  return hidden ? may : tl::unexpected(hidden.error());
}

// Whether to publish the model that the job has made. The scan's previous model may have been
// withdrawn or limited to some levels since the order.
Expected<bool> ScanService::may_be_public(const JobRun& run, const ScanOrder& order) {
  const auto entry = options_.jobs.find_scan(run.job().scan.value_or(ScanId()));
  if (!entry) return tl::unexpected(entry.error());
  if (!*entry || !(*entry)->model) return order.is_public;
  const auto before = options_.catalogue.find(*(*entry)->model);
  if (!before) return tl::unexpected(before.error());
  if (!*before) return order.is_public;
  if ((*before)->public_part) return false;
  return order.is_public ||
         (order.is_public_as_before && (*before)->state == ModelState::kPublished);
}

// Makes `built` the scan's model, unless it is a draft and the scan's current model is published.
Expected<void> ScanService::show(const JobRun& run, bool is_public, const BuiltModel& built) {
  auto entry = options_.jobs.find_scan(run.job().scan.value_or(ScanId()));
  if (!entry) return tl::unexpected(entry.error());
  if (!*entry) return {};
  auto& shown = (*entry)->model;
  // Hides the scan's previous model, because visitors see only one model of a scan.
  if (is_public && shown && *shown != built.model) {
    auto hidden = options_.catalogue.set_state(*shown, ModelState::kDraft);
    if (!hidden) return hidden;
  }
  if (!is_public && shown) {  // a draft does not replace the model that visitors see
    const auto before = options_.catalogue.find(*shown);
    if (!before) return tl::unexpected(before.error());
    if (*before && (*before)->state == ModelState::kPublished) return {};
  }
  shown = built.model;
  (*entry)->built = built.geometry;
  return options_.jobs.update(**entry, claim_of(run.job()));
}

}  // namespace vitrine::server
