// SPDX-License-Identifier: Apache-2.0
// The catalogue of jobs and scans. It stores the progress of each job and the daemon that works on
// it. Its data survives restarts of the daemons.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/sha256.h"
#include "server/catalogue/id.h"

namespace vitrine::server {

enum class JobKind : std::uint8_t { kScan = 0, kCalibrate = 1, kReprocess = 2, kPublish = 3 };

// Whether a job of this kind needs the scanner exclusively. Jobs of other kinds can run while the
// scanner is in use.
constexpr bool needs_scanner(JobKind kind) {
  return kind == JobKind::kScan || kind == JobKind::kCalibrate;
}

enum class JobState : std::uint8_t {
  kQueued = 0,
  kRunning = 1,
  kPaused = 2,
  kDone = 3,
  kFailed = 4,
  kCancelled = 5
};

constexpr bool has_ended(JobState state) {
  return state >= JobState::kDone;
}

struct JobRecord {
  JobId id;
  JobKind kind = JobKind::kScan;
  JobState state = JobState::kQueued;
  std::string scanner;  // name of the scanner; empty if the job needs no scanner
  std::optional<ScanId> scan;
  std::optional<ModelId> model;  // the model that the job made
  std::string stage;             // stage of the job, one word; empty until the job starts
  double progress = 0;           // progress of the whole job, 0..1
  std::string error;             // error message of one line; empty unless the job failed
  std::string parameters;        // JSON, read by the task that runs the job
  // Times in milliseconds since 1970, UTC. `ended` is 0 until the job ends.
  std::int64_t created = 0, ended = 0;
  std::string webhook = {};  // URL that is called when the job ends; empty: none
  // Number of runs that were started since a run last ended properly. More than 1 if a daemon died
  // during a run.
  std::uint32_t attempts = 0;
  // Increases each time a daemon claims the job, or a client cancels the job while no daemon works
  // on it. The catalogue refuses to store a record with a smaller value.
  std::uint64_t fence = 0;
  // Repairs and losses of the build, one line for each kind. Empty if there were none.
  std::string repairs = {};
  // ID of the token that uploaded the job's file, or that ordered to reprocess a scan. Daemons that
  // build models serve the jobs of different owners in turn. Empty for jobs that use a scanner.
  std::string owner = {};

  bool operator==(const JobRecord&) const = default;
};

// The quality of the camera's pictures during a scan. The members are shares of picture rows, from
// 0 to 1. `empty` is the share of all rows that show no laser stripe. `saturated` and `doubled` are
// shares of the rows that show a stripe: rows that are saturated, and rows with two stripes.
struct ScannedRows {
  double empty = 0, saturated = 0, doubled = 0;

  bool operator==(const ScannedRows&) const = default;
};

struct ScanEntry {
  ScanId id;
  JobId job;  // the newest job that has measured the scan
  std::string scanner;
  bool is_public = false;  // whether the running scan is visible without a token
  std::string title;
  std::string parameters;   // parameters of the scan, as JSON
  int steps = 0, step = 0;  // steps per revolution of the turntable, and number of steps done
  std::uint64_t points = 0;
  int calibration = 0;  // number of the calibration that the scan uses
  std::optional<ModelId> model;
  std::int64_t created = 0;
  std::optional<ScannedRows> rows;  // nullopt: not known yet
  // ID of the turntable revolution that the scan measures. The scan's data folder stores the ID of
  // the revolution whose steps the folder contains. If the two IDs differ, another daemon has
  // measured the scan since, and the steps in the folder cannot be used. Empty if an earlier
  // version of Vitrine began the scan.
  std::string revolution = {};
  // The hash of the geometry of `model` that was built from the scan (geometry_hash()); nullopt if
  // unknown. If it is unknown, clients without a token do not see the scan, because the file of
  // `model` may have been replaced by a file that shows another object.
  std::optional<Sha256> built = {};

  bool operator==(const ScanEntry&) const = default;
};

// The right of a running job to change a model or a scan. This right ends when another daemon
// claims the job.
struct JobClaim {
  JobId job;
  std::uint64_t fence = 0;  // JobRecord::fence of the claimed job
};

// The idempotency key of a request. A request with a key takes effect only once, even if it is sent
// several times.
struct IdempotencyKey {
  std::string key;   // the key as the client sent it
  Sha256 request{};  // hash of the request's content
};

// A request for one page of the list of jobs or scans, newest first.
template <class Id>
struct PageOf {
  std::optional<Id> after;   // ID of the previous page's last entry
  std::uint32_t limit = 50;  // 1..kMaxPage of catalogue.h
};

// The number of jobs in each state, in the order of JobState.
using JobCounts = std::array<std::uint64_t, 6>;

// A lease on a job or a scanner. It expires after `time` unless it is renewed. The database's clock
// measures the time.
struct Lease {
  std::string holder;  // ID of the daemon, which does not change when the daemon restarts
  std::chrono::milliseconds time;
};

// The daemon that drives a scanner, or drove it last.
struct ScannerDriver {
  std::string scanner, holder;
  // URL at which other daemons reach this daemon, "http://HOST:PORT". Empty if other daemons cannot
  // reach it.
  std::string address;
  bool is_current = false;  // whether the driver's lease is still valid
};

// Safe to use from several threads at once, and by several processes on the same data. All
// functions fail with kIo if the database fails and with kLimit if the disk is full. The comments
// of the functions state when they fail with kState.
class JobCatalogue {
 public:
  virtual ~JobCatalogue() = default;

  // Adds a job in one transaction. If `key` is given, adds the job's idempotency key, too. If
  // `scan` is given, adds that scan or replaces the scan with the same ID. Fails with kState if the
  // job's ID or the key exists already.
  virtual Expected<void> add(const JobRecord& job, const std::optional<ScanEntry>& scan,
                             const std::optional<IdempotencyKey>& key) = 0;

  // Both overloads replace a stored record. `by` is the claim of the job that measures the scan.
  // The first overload ends the job's lease unless the new state is kRunning. Both fail with kState
  // if the record does not exist, or if another daemon has claimed or ended the job since the
  // caller read or claimed it.
  virtual Expected<void> update(const JobRecord& job) = 0;
  virtual Expected<void> update(const ScanEntry& scan, const JobClaim& by) = 0;

  // Claims a job: sets its state to running, increments its fence and starts a lease. Returns
  // nullopt unless the job is queued, or is running with an expired lease. The claim does not
  // withdraw an earlier request to cancel the job.
  virtual Expected<std::optional<JobRecord>> claim(const JobId& id, const Lease& lease) = 0;
  // Returns at most `limit` jobs of these kinds that can be claimed. Owners take turns: the owner
  // with the fewest running and already returned jobs comes first, and then the oldest job. Counts
  // the jobs of each scanner separately. Returns jobs with an expired lease only if `overdue`.
  virtual Expected<std::vector<JobRecord>> waiting_jobs(std::span<const JobKind> kinds,
                                                        std::uint32_t limit, bool overdue) = 0;
  // Renews the lease of a job and stores its stage and progress. Returns true if a cancellation was
  // requested. Fails with kState if another daemon has claimed or ended the job; the caller must
  // then abandon the job.
  virtual Expected<bool> renew(const JobRecord& job, std::chrono::milliseconds lease) = 0;
  // Cancels a job. If no daemon works on the job, ends the job at time `now`, in milliseconds since
  // 1970, UTC. Its state is then kCancelled, or kDone if a daemon had stored the model and died. If
  // a daemon works on the job, that daemon receives the request when it renews its lease. Returns
  // the changed job. Fails with kState if the job does not exist or has ended.
  virtual Expected<JobRecord> cancel(const JobId& id, std::int64_t now) = 0;
  // Ends the leases of all jobs of `holder`, a daemon that no longer works on them.
  virtual Expected<void> drop_leases(const std::string& holder) = 0;

  // Acquires a scanner for `lease.holder`, and returns the number of the new epoch that begins.
  // Returns nullopt if another holder's lease is valid.
  virtual Expected<std::optional<std::uint64_t>> take_scanner(const std::string& scanner,
                                                              const Lease& lease,
                                                              const std::string& address) = 0;
  // Renews the lease on a scanner. Fails with kState if the scanner was acquired again in a later
  // epoch.
  virtual Expected<void> renew_scanner(const std::string& scanner, std::uint64_t epoch,
                                       std::chrono::milliseconds lease) = 0;
  // Releases all scanners of `holder`.
  virtual Expected<void> drop_scanners(const std::string& holder) = 0;
  virtual Expected<std::vector<ScannerDriver>> scanner_drivers() = 0;

  virtual Expected<std::optional<JobRecord>> find_job(const JobId& id) = 0;
  virtual Expected<std::optional<ScanEntry>> find_scan(const ScanId& id) = 0;
  virtual Expected<std::vector<JobRecord>> jobs(const PageOf<JobId>& page) = 0;
  virtual Expected<std::vector<ScanEntry>> scans(const PageOf<ScanId>& page) = 0;
  // The next two functions return the oldest job first.
  virtual Expected<std::vector<JobRecord>> unfinished_jobs() = 0;
  virtual Expected<std::vector<JobRecord>> paused_jobs() = 0;
  virtual Expected<JobCounts> count_jobs() = 0;

  // Returns the jobs that have ended and whose webhooks have not been called yet, oldest first.
  virtual Expected<std::vector<JobRecord>> unnotified_jobs() = 0;
  // Claims up to 16 jobs that have ended and whose webhooks are neither called nor claimed, and
  // returns these jobs. While the lease is valid, no other daemon calls their webhooks.
  virtual Expected<std::vector<JobRecord>> claim_unnotified(const Lease& lease) = 0;
  // Renews the lease on a job's webhook. Fails with kState if another daemon has claimed or called
  // the webhook.
  virtual Expected<void> renew_unnotified(const JobId& id, const Lease& lease) = 0;
  // Records that a job's webhook was called or will not be tried again. Fails with kState if the
  // job does not exist.
  virtual Expected<void> set_notified(const JobId& id) = 0;

  // The job that was added with an idempotency key, and the hash of its request.
  struct Earlier {
    JobId job;
    Sha256 request{};
  };
  virtual Expected<std::optional<Earlier>> find_key(const std::string& key) = 0;

  // Removes old keys and jobs in one transaction: keys whose jobs have ended and were added before
  // `keys_before`, and jobs that ended before `jobs_before`. Both times are in milliseconds since
  // 1970. Keeps jobs that have not ended and jobs that a scan or a key refers to. Returns the
  // number of jobs removed.
  virtual Expected<std::size_t> forget(std::int64_t keys_before, std::int64_t jobs_before) = 0;
};

}  // namespace vitrine::server
