// SPDX-License-Identifier: Apache-2.0
// Scanners, their scans and calibrations, for the handlers of the API: orders become jobs, and a
// scan becomes a model. A scan is a folder DATA/scans/ID, a row in the catalogue, and a view in
// memory while it grows.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "server/jobs/job_queue.h"
#include "server/jobs/scanner_claims.h"
#include "server/jobs/scanner_station.h"
#include "server/store/object_store.h"
#include "server/store/quota.h"

namespace vitrine {

struct ScanInfo {
  ScanEntry entry;
  JobStatus job;  // the newest that scans or scanned it
};

struct ScanStarted {
  ScanId scan;
  JobId job;
};

// All of it outlives the service.
struct ScanMeans {
  ObjectStore& store;
  Catalogue& catalogue;
  JobCatalogue& jobs;
  const Log& events;
  std::filesystem::path data;                        // of the installation
  std::filesystem::path program = "/proc/self/exe";  // BuildOrder::program
  std::chrono::milliseconds patience{10'000};        // that devices stay open for the next command
  JobTask publishing = {};                           // what becomes of jobs of that kind
  Quota* quota = nullptr;                            // of which models take; null: there is none
  TakenJobs taken = {};                              // which jobs are done here
  const ScannerClaims* claims = nullptr;  // null: every scanner is here, and this daemon's
};

// Thread-safe. Errors: kState where something is not possible now, kBadInput where an idempotency
// key was used otherwise, kIo.
class ScanService {
 public:
  ScanService(const ScanMeans& means, std::vector<std::unique_ptr<ScannerBackend>> scanners);
  ~ScanService() { stop(); }

  // Takes up what an earlier daemon left, and looks for the scanners.
  Expected<void> start();
  // Puts aside what runs: it goes on at the next start. Laser and motor are off on return.
  void stop();

  JobQueue& jobs() { return queue_; }

  std::vector<ScannerStatus> scanners();
  ScannerStation* scanner(std::string_view name);  // null where there is none of that name
  std::vector<std::string> names() const;          // of those that are configured here
  // As those of ScannerClaims.
  std::optional<std::string> address_of(const std::string& name) const;
  std::map<std::string, std::vector<std::string>> others() const;
  // A fresh picture, the latest of the scan while one is under way.
  Expected<Frame> picture(ScannerStation& scanner);
  Expected<JobRecord> calibrate(ScannerStation& scanner, const CalibrationOrder& order,
                                const std::optional<OnceKey>& once);

  // `order.scanner` is that of a station.
  Expected<ScanStarted> scan(const ScanOrder& order, const std::optional<OnceKey>& once);
  // Another model of a scan that nobody works on, that has steps, and whose pictures were kept
  // where the order needs them; its own state stays.
  Expected<ScanStarted> reprocess(const ScanEntry& scan, const ScanOrder& order,
                                  const std::optional<OnceKey>& once);
  Expected<void> pause(const ScanEntry& scan);
  // Goes on with one that is paused, or, as a new job, that failed.
  Expected<void> resume(const ScanEntry& scan);
  // One of any kind that is paused, or that waits for somebody.
  Expected<JobStatus> resume(const JobRecord& job);

  Expected<std::optional<ScanInfo>> find(const ScanId& id);
  Expected<std::vector<ScanInfo>> list(const PageOf& page);
  static Expected<ScanOrder> order_of(const ScanEntry& scan);

  // Null where nothing is to be seen yet; kState where the scan's folder is gone.
  Expected<std::shared_ptr<const ScanView>> view(const ScanEntry& scan);

 private:
  class Listener;
  struct Live {
    ScanEntry entry;
    std::shared_ptr<const ScanView> view;
  };

  Expected<JobEnd> work(JobRun& run);
  Expected<ScanEntry> scan_of(const JobRun& run);
  Expected<JobEnd> work_on_scan(JobRun& run, ScannerStation& station);
  Expected<void> settle_turn(JobRun& run, ScanEntry& scan);
  Expected<void> check_turn(const ScanEntry& scan) const;
  Expected<JobEnd> reprocess(JobRun& run, ScannerStation& station);
  Expected<JobEnd> calibrate(JobRun& run, ScannerStation& station);
  Expected<JobEnd> make_model(JobRun& run, const ScanOrder& order, const TriangleMesh& mesh);
  Expected<void> show(const JobRun& run, const ScanOrder& order, const ModelId& model);
  std::filesystem::path folder_of(const ScanId& id) const;
  std::uint64_t stops_of(const std::string& name);  // of that scanner so far
  Expected<ScanInfo> with_job(ScanEntry entry);
  void keep(const ScanEntry& entry, const JobRecord& by);
  Expected<void> recall();
  void recall(JobRecord job);
  Expected<ScanStarted> add(JobRecord job, ScanEntry scan, const std::optional<OnceKey>& once);
  Expected<void> check_unused(const ScanEntry& scan);

  const ScanMeans means_;
  std::mutex stopping_;  // one stop() at a time
  std::vector<std::unique_ptr<ScannerBackend>> backends_;

  std::mutex mutex_;                                         // guards what follows
  std::map<ScanId, Live> live_;                              // those that grow
  std::map<ScanId, std::shared_ptr<const ScanView>> views_;  // of a few that have ended

  JobQueue queue_;
  std::vector<std::unique_ptr<ScannerStation>> stations_;
};

}  // namespace vitrine
