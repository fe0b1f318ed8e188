// SPDX-License-Identifier: Apache-2.0
// Gives the handlers of the API access to the scanners, scans and calibrations. Makes jobs from
// orders, and models from scans. A scan consists of a folder DATA/scans/ID, a row in the catalogue,
// and a view in memory while it runs.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "server/jobs/job_queue.h"
#include "server/jobs/periodic_task.h"
#include "server/jobs/scanner_claims.h"
#include "server/jobs/scanner_station.h"
#include "server/sandbox/build_child.h"
#include "server/store/object_store.h"
#include "server/store/quota.h"

namespace vitrine::server {

struct ScanInfo {
  ScanEntry entry;
  JobStatus job;  // the newest job that measures the scan
};

struct ScanStarted {
  ScanId scan;
  JobId job;
};

// All references and pointers must outlive the service.
struct ScanServiceOptions {
  ObjectStore& store;
  Catalogue& catalogue;
  JobCatalogue& jobs;
  const Log& events;
  std::filesystem::path data;                                // data folder of the installation
  std::filesystem::path program = "/proc/self/exe";          // see BuildOrder::program
  std::function<std::uint64_t()> disk_reserve = no_reserve;  // returns BuildOrder::disk_reserve
  std::chrono::milliseconds idle_timeout{10'000};  // devices unused for this long are closed
  JobTask publishing = {};                         // runs the jobs that publish models
  Quota* quota = nullptr;                          // limits the bytes of models; null: no limit
  TakenJobs taken = {};                            // the jobs that this daemon runs
  const ScannerClaims* claims = nullptr;           // null: this daemon drives every scanner
  // Called by a job after it has added a model to the catalogue and before the job ends. An
  // exception is logged.
  std::function<void(const ModelId&)> when_added = {};
  // The clock for the time limit of a laser that an operator has switched on.
  std::function<ScannerStation::Clock::time_point()> now = ScannerStation::Clock::now;
};

// Thread-safe. All functions fail with kState if the call is not possible now, with kBadInput if an
// idempotency key was used for another request, and with kIo if the catalogue, the disk or a device
// fails.
class ScanService {
 public:
  ScanService(const ScanServiceOptions& options,
              std::vector<std::unique_ptr<ScannerBackend>> scanners);
  ~ScanService() { stop(); }

  // Continues the jobs that an earlier run of the daemon left unfinished, and looks for the
  // scanners.
  Expected<void> start();
  // Stops running jobs, which continue at the next start. Laser and motor are off when the function
  // returns.
  void stop();

  JobQueue& jobs() { return queue_; }

  std::vector<ScannerStatus> scanners();
  ScannerStation* scanner(std::string_view name);  // null if there is no such scanner
  std::vector<std::string> names() const;          // scanners configured in this daemon
  // These two functions call the function of the same name in ScannerClaims.
  std::optional<std::string> address_of(const std::string& name) const;
  std::map<std::string, std::vector<std::string>> others() const;
  // Returns a new picture, or, while a scan runs, the latest picture of the scan.
  Expected<acquisition::Frame> picture(ScannerStation& scanner);
  Expected<JobRecord> calibrate(ScannerStation& scanner, const CalibrationOrder& order,
                                const std::optional<IdempotencyKey>& key);

  // Starts a scan. `order.scanner` must be the name of a configured scanner.
  Expected<ScanStarted> scan(const ScanOrder& order, const std::optional<IdempotencyKey>& key);
  // Starts a job that makes another model from a scan. The scan must have measured steps, and no
  // other job may use the scan. If the order needs the scan's pictures, they must have been kept.
  // If visitors may see only some levels of the scan's current model, the new model becomes a
  // draft, because its levels differ. `owner` is the token of the client that has ordered the job,
  // if known; the jobs of different tokens take turns. Does not change the scan's state.
  Expected<ScanStarted> reprocess(const ScanEntry& scan, const ScanOrder& order,
                                  const std::optional<IdempotencyKey>& key,
                                  const std::optional<TokenId>& owner = {});
  // Deletes the measured data of a scan: profiles, points and kept pictures. Keeps the scan's
  // record and its models. No job may use the scan.
  Expected<void> remove_data(const ScanEntry& scan);
  Expected<void> pause(const ScanEntry& scan);
  // Continues a paused scan. Continues a failed scan with a new job.
  Expected<void> resume(const ScanEntry& scan);
  // Continues a job of any kind that is paused or waits for the operator.
  Expected<JobStatus> resume(const JobRecord& job);

  Expected<std::optional<ScanInfo>> find(const ScanId& id);
  Expected<std::vector<ScanInfo>> list(const PageOf<ScanId>& page);
  static Expected<ScanOrder> order_of(const ScanEntry& scan);

  // Returns the view of a scan, or null if the scan has no data yet. Fails with kState if its
  // folder is missing.
  Expected<std::shared_ptr<const ScanView>> view(const ScanEntry& scan);

 private:
  class Listener;
  struct Live {
    ScanEntry entry;
    std::shared_ptr<const ScanView> view;
  };

  Expected<JobEnd> work(JobRun& run);
  void tell_added(const ModelId& model);
  Expected<JobEnd> work_on_kind(JobRun& run);
  Expected<ScanEntry> scan_of(const JobRun& run);
  Expected<JobEnd> work_on_scan(JobRun& run, ScannerStation& station);
  Expected<void> settle_revolution(JobRun& run, ScanEntry& scan);
  Expected<void> check_revolution(const ScanEntry& scan) const;
  Expected<JobEnd> reprocess(JobRun& run, ScannerStation& station);
  Expected<JobEnd> calibrate(JobRun& run, ScannerStation& station);
  Expected<JobEnd> make_model(JobRun& run, const ScanOrder& order, const TriangleMesh& mesh);
  // A model, and the hash of the geometry that was built for it.
  struct BuiltModel {
    ModelId model;
    Sha256 geometry{};
  };
  struct AddedModel {
    ModelId model;
    bool is_public = false;
  };
  Expected<AddedModel> add_model(JobRun& run, const ScanOrder& order, const ChildResult& built);
  Expected<bool> may_be_public(const JobRun& run, const ScanOrder& order);
  Expected<bool> stay_public(const JobRun& run, const ScanOrder& order, const ModelId& model);
  Expected<void> show(const JobRun& run, bool is_public, const BuiltModel& built);
  std::filesystem::path folder_of(const ScanId& id) const;
  std::uint64_t stops_of(const std::string& name);  // number of emergency stops of the scanner
  Expected<ScanInfo> with_job(ScanEntry entry);
  void keep(const ScanEntry& entry, const JobRecord& by);
  Expected<void> recall();
  void recall(JobRecord job);
  Expected<ScanStarted> add(JobRecord job, ScanEntry scan,
                            const std::optional<IdempotencyKey>& key);
  Expected<void> check_unused(const ScanEntry& scan);

  const ScanServiceOptions options_;
  std::mutex stopping_;  // lets one stop() run at a time
  std::vector<std::unique_ptr<ScannerBackend>> backends_;

  std::mutex mutex_;                                         // guards live_ and views_
  std::map<ScanId, Live> live_;                              // running scans
  std::map<ScanId, std::shared_ptr<const ScanView>> views_;  // views of a few ended scans

  JobQueue queue_;
  std::vector<std::unique_ptr<ScannerStation>> stations_;
  std::optional<PeriodicTask> laser_watch_;  // calls watch_manual_laser() of the stations
};

}  // namespace vitrine::server
