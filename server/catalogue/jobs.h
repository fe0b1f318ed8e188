// SPDX-License-Identifier: Apache-2.0
// Which jobs and scans there are, how far they have come, and which daemon works on which job: what
// outlives a daemon.
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
#include "server/catalogue/model_id.h"

namespace vitrine {

using JobId = ModelId;   // jobs and scans are named
using ScanId = ModelId;  // as models are

enum class JobKind : std::uint8_t { kScan = 0, kCalibrate = 1, kReprocess = 2, kPublish = 3 };

// Whether it has the scanner for itself; all others share their time.
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
  std::string scanner;  // its name; empty where none has to do with it
  std::optional<ScanId> scan;
  std::optional<ModelId> model;         // what came of it
  std::string stage;                    // what it is at, in a word; empty before it starts
  double progress = 0;                  // 0..1, of the whole job
  std::string error;                    // one line; empty unless it failed
  std::string parameters;               // JSON, for who runs it
  std::int64_t created = 0, ended = 0;  // milliseconds since 1970, UTC; 0: not yet
  std::string webhook = {};             // a URL that is told of its end; empty: none
  std::uint32_t attempts = 0;           // how often it was begun since it last ended in order
  std::uint64_t fence = 0;  // how often it was taken: who took it before changes nothing any more

  bool operator==(const JobRecord&) const = default;
};

// 0..1: of all rows of the pictures those without a stripe, of the others those that are saturated,
// and those that show two.
struct ScannedRows {
  double empty = 0, saturated = 0, doubled = 0;

  bool operator==(const ScannedRows&) const = default;
};

struct ScanEntry {
  ScanId id;
  JobId job;  // the newest that scans; others make further models of it
  std::string scanner;
  bool is_public = false;  // everybody may see it grow
  std::string title;
  std::string parameters;   // JSON
  int steps = 0, step = 0;  // of a turn; done so far
  std::uint64_t points = 0;
  int calibration = 0;  // its number
  std::optional<ModelId> model;
  std::int64_t created = 0;
  std::optional<ScannedRows> rows;  // nothing: not known yet
  // Names what was measured, here and in the folder that holds it: what another daemon has left of
  // the scan has another name, and is not to be gone on with. Empty: an earlier version began it.
  std::string turn = {};

  bool operator==(const ScanEntry&) const = default;
};

// The right of a job to change a model or a scan: until somebody else takes the job.
struct JobClaim {
  JobId job;
  std::uint64_t fence = 0;  // JobRecord::fence
};

// A request that is to have its effect once, however often it is sent.
struct OnceKey {
  std::string key;   // the client's
  Sha256 request{};  // of what it asked for
};

// Newest first.
struct PageOf {
  std::optional<ModelId> after;  // the last of the page before
  std::uint32_t limit = 50;      // 1..kMaxPage of catalogue.h
};

// How many jobs are in each state, in the order of JobState.
using JobCounts = std::array<std::uint64_t, 6>;

// For how long a job is its holder's, by the database's clock.
struct Lease {
  std::string holder;  // the same at the next start of the same daemon
  std::chrono::milliseconds time;
};

// Who drives a scanner, or did last.
struct ScannerDriver {
  std::string scanner, holder;
  std::string address;      // where other daemons reach it, "http://HOST:PORT"; empty: nowhere
  bool is_current = false;  // its lease has not run out
};

// Safe to use from several threads at once, and by several processes on the same data. Errors are
// kIo where the database refuses, kLimit where the disk is full, kState as stated.
class JobCatalogue {
 public:
  virtual ~JobCatalogue() = default;

  // Adds a job, and its scan where one is given or writes over the scan of that id, in one
  // transaction. kState where the job's id or the key exists.
  virtual Expected<void> add(const JobRecord& job, const std::optional<ScanEntry>& scan,
                             const std::optional<OnceKey>& once) = 0;

  // Write over the record of that id. kState where there is none, or somebody has taken or ended
  // the job since, which for a scan is `by`. Where a job does not run afterwards, its lease ends.
  virtual Expected<void> update(const JobRecord& job) = 0;
  virtual Expected<void> update(const ScanEntry& scan, const JobClaim& by) = 0;

  // Takes the job, which runs from now on, with another fence. Nothing where it does not wait, and
  // no lease has run out: somebody else has it. That it is to be cancelled is still so.
  virtual Expected<std::optional<JobRecord>> claim(const JobId& id, const Lease& lease) = 0;
  // Of those kinds that are to be taken, the oldest; at most `limit`. Those whose holder has let
  // the lease run out are only of them where they are `overdue`, too.
  virtual Expected<std::vector<JobRecord>> waiting_jobs(std::span<const JobKind> kinds,
                                                        std::uint32_t limit, bool overdue) = 0;
  // Has the lease begin anew and tells stage and progress. True: somebody wants the job ended.
  // kState where somebody else has taken or ended it: then it is to be left alone.
  virtual Expected<bool> renew(const JobRecord& job, std::chrono::milliseconds lease) = 0;
  // Ends a job that nobody works on, at `now`; who has it learns of the wish when they renew. The
  // job as it is then. kState where there is none, or it has ended.
  virtual Expected<JobRecord> cancel(const JobId& id, std::int64_t now) = 0;
  // Whatever job the holder had is to be taken: they are dead.
  virtual Expected<void> drop_leases(const std::string& holder) = 0;

  // Has the scanner be the holder's, whose new epoch is the result; nothing where it is another's
  // whose lease goes on.
  virtual Expected<std::optional<std::uint64_t>> take_scanner(const std::string& scanner,
                                                              const Lease& lease,
                                                              const std::string& address) = 0;
  // kState where a later epoch has begun.
  virtual Expected<void> renew_scanner(const std::string& scanner, std::uint64_t epoch,
                                       std::chrono::milliseconds lease) = 0;
  // Others may take what scanners the holder had.
  virtual Expected<void> drop_scanners(const std::string& holder) = 0;
  virtual Expected<std::vector<ScannerDriver>> scanner_drivers() = 0;

  virtual Expected<std::optional<JobRecord>> find_job(const JobId& id) = 0;
  virtual Expected<std::optional<ScanEntry>> find_scan(const ScanId& id) = 0;
  virtual Expected<std::vector<JobRecord>> jobs(const PageOf& page) = 0;
  virtual Expected<std::vector<ScanEntry>> scans(const PageOf& page) = 0;
  virtual Expected<std::vector<JobRecord>> unfinished_jobs() = 0;  // oldest first
  virtual Expected<std::vector<JobRecord>> paused_jobs() = 0;      // likewise
  virtual Expected<JobCounts> count_jobs() = 0;

  // Those that have ended and whose webhooks have not been told so; oldest first.
  virtual Expected<std::vector<JobRecord>> untold_jobs() = 0;
  // Of those, a few that nobody else is to tell meanwhile.
  virtual Expected<std::vector<JobRecord>> claim_untold(const Lease& lease) = 0;
  // Has the lease on telling begin anew. kState where another is to tell it, or has.
  virtual Expected<void> renew_untold(const JobId& id, const Lease& lease) = 0;
  // The webhook was told, or nobody tries any more. kState where there is no such job.
  virtual Expected<void> set_told(const JobId& id) = 0;

  // The job that was added with this key, and the request of then.
  struct Earlier {
    JobId job;
    Sha256 request{};
  };
  virtual Expected<std::optional<Earlier>> find_once(const std::string& key) = 0;

  // Takes away, in one transaction, the keys of jobs that were added before `keys_before` and the
  // jobs that ended before `jobs_before`, both in milliseconds since 1970: but for jobs that have
  // not ended, and those that a scan or a key still names. The number of jobs.
  virtual Expected<std::size_t> forget(std::int64_t keys_before, std::int64_t jobs_before) = 0;
};

}  // namespace vitrine
