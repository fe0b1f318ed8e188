// SPDX-License-Identifier: Apache-2.0
// Jobs and their states. Each scanner has a lane of its own and at most one unfinished job; what
// needs no scanner shares another lane and waits there. All is in the catalogue, so that a daemon
// that died goes on where it was, and several share what is to be done: who begins a job takes it,
// holds it by a lease that is renewed, and lets go of it once somebody else has it.
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/catalogue/jobs.h"
#include "server/jobs/heart.h"
#include "server/jobs/lane.h"
#include "server/log/log.h"

namespace vitrine {

// What somebody wants of a job that runs.
enum class JobWish : std::uint8_t {
  kNone,
  kPause,   // to put it aside, until it is resumed
  kCancel,  // to end it; what is done stays
  kStop,    // to put it aside, because the daemon ends
  kLost,    // to leave it alone: somebody else has it
};

enum class JobEnd : std::uint8_t { kDone, kPutAside };  // the latter where a wish asked for it

struct JobStatus {
  JobRecord record;
  std::optional<double> eta;  // seconds
  std::string note;           // what it waits for: a camera that is gone; mostly empty

  bool operator==(const JobStatus&) const = default;
};

// A job as its task sees it. Thread-safe.
class JobRun {
 public:
  explicit JobRun(JobRecord job) : status_{std::move(job), std::nullopt, {}} {}

  JobStatus status() const;  // also once it has ended
  JobRecord job() const { return status().record; }
  JobWish wish() const;
  // Of its scanner's emergency stops, how many whoever handed it in knew of.
  std::uint64_t stops_known() const;

  // `stage` in a word; `progress` 0..1 of the whole job, which never goes back; seconds that are
  // left, where known; JobStatus::note.
  void report(std::string_view stage, double progress, std::optional<double> eta = {},
              std::string_view note = {});
  void made(const ModelId& model);
  // What was done so far is to be done again.
  void begin_anew();

  // Tells what somebody is to do, and waits as a paused job until it is resumed; false where a wish
  // comes instead. A daemon that ends leaves the job paused: its task starts anew.
  bool await_resume(std::string_view stage, double progress, std::string_view note);

 private:
  friend class JobQueue;
  friend class Reaction;
  // Replaces the one before; {} takes it away, and it is not being called any more on return.
  void when_asked(std::function<void()> react);
  void ask(JobWish wish, std::string_view reason = {});
  bool go_on();             // false where it does not wait
  bool is_at_work() const;  // its task has not returned

  mutable std::mutex mutex_;  // guards what follows
  JobStatus status_;
  JobWish wish_ = JobWish::kNone;
  bool waits_ = false;        // in await_resume()
  std::string pause_reason_;  // that came with kPause; its note from then on
  std::condition_variable changed_;
  std::uint64_t stops_known_ = 0;
  std::function<void()> react_;

  std::function<void(const JobRecord&)> entered_stage_;  // set once, before the task starts
};

// Has `react` called, by another thread, when a wish comes, and at once where one has come already,
// as long as this lives; one at a time for a run.
class Reaction {
 public:
  Reaction(JobRun& run, std::function<void()> react) : run_(run) {
    run_.when_asked(std::move(react));
  }
  ~Reaction() { run_.when_asked({}); }
  Reaction(const Reaction&) = delete;
  Reaction& operator=(const Reaction&) = delete;

 private:
  JobRun& run_;
};

// Does one job, or goes on with it. An error is the end of the job, unless a wish came meanwhile.
using JobTask = std::function<Expected<JobEnd>(JobRun& run)>;

// Which jobs a daemon does itself; the others it leaves to those that do.
struct TakenJobs {
  bool builds = true, scans = true;
  std::string holder = {};  // Lease::holder
  std::function<bool(const std::string& scanner)> drives = [](const std::string&) { return true; };

  bool has(const JobRecord& job) const {
    return job.kind == JobKind::kPublish ? builds : scans && drives(job.scanner);
  }
};

// Thread-safe. Errors: kState where a job is not in a state for that, kIo of the catalogue.
class JobQueue {
 public:
  JobQueue(JobCatalogue& catalogue, const Log& events, JobTask task, TakenJobs taken = {});
  ~JobQueue() { stop(); }

  // Has `told` called with every job that has ended and has a webhook, by one of all daemons, once
  // unless that one dies meanwhile: for who comes before start(). Of what is not told within ten
  // minutes, somebody's is called again.
  void when_ended(std::function<void(const JobStatus&)> told) { ended_ = std::move(told); }
  // To be asked when it comes to telling, which may be that while later: false where another has
  // told it meanwhile.
  bool may_tell(const JobId& id);

  // Takes up what an earlier daemon left: what was paused stays paused, all else goes on, but for
  // what three daemons have died at: that has failed. From then on there is a beat() twice a
  // second.
  Expected<void> start();

  // Renews the leases of what runs here, hears of what others want of it, and looks for what waits
  // to be done, or to be told.
  void beat();

  // Every job that runs is put aside, and every lane ends.
  void stop();
  bool is_stopping() const;

  // The job that a request with this key began; kBadInput where it was another request.
  Expected<std::optional<JobRecord>> begun_by(const std::optional<OnceKey>& once) const;

  // kState where the scanner is busy; kBadInput where the key was used with another request, and
  // with the same one the job of then is the result. `stops`: JobRun::stops_known().
  Expected<JobRecord> add(const JobRecord& job, const std::optional<ScanEntry>& scan,
                          const std::optional<OnceKey>& once, std::uint64_t stops = 0);

  // `reason`, and what to do: its note until it is resumed or the daemon ends.
  Expected<JobStatus> pause(const JobId& id, std::string_view reason = {});
  Expected<JobStatus> resume(const JobId& id, std::uint64_t stops = 0);
  Expected<JobStatus> cancel(const JobId& id);

  // Nothing where there is no such job.
  Expected<std::optional<JobStatus>> find(const JobId& id);
  Expected<std::vector<JobStatus>> list(const PageOf& page);
  Expected<JobCounts> count() { return catalogue_.count_jobs(); }

  // An unfinished job of this daemon, to be watched to its end; null where there is none.
  std::shared_ptr<const JobRun> run(const JobId& id) const;
  // The same of any daemon's, seen a beat later where it is another's.
  Expected<std::shared_ptr<const JobRun>> watch(const JobId& id);

  // The unfinished job of a scanner.
  std::optional<JobStatus> job_of(const std::string& scanner) const;

  // The oldest unfinished job, of whichever daemon, that is such a one.
  Expected<std::optional<JobRecord>> job_where(const std::function<bool(const JobRecord&)>& is);

  // Has something short done by the scanner's lane, where all of its jobs run. kState, and nothing
  // is done, where it is busy; a job that is put aside is in the way unless `beside_paused`.
  Expected<void> post_command(const std::string& scanner, std::function<void()> command,
                              bool beside_paused = false);

  // Where the scanner's devices are used.
  Lane& lane(const std::string& scanner);

 private:
  using Run = std::shared_ptr<JobRun>;

  // With the lock held, as all until the next line.
  Expected<void> check_free(const std::string& scanner) const;
  Expected<Run> unfinished(const JobId& id) const;
  Run run_of(const std::string& scanner) const;
  void take_up(const JobRecord& job, std::uint64_t stops);
  void give_up(const Run& run);
  void post(const Run& run);
  bool set_state(const Run& run, JobState state);  // false where somebody else has it
  void lose(const Run& run);
  bool take(const Run& run);
  Lane& lane_of(const std::string& name);

  void work(const Run& run);
  static JobState state_after(JobRun& run, const Expected<JobEnd>& result);
  void end(const Run& run, const Expected<JobEnd>& result);
  static bool is_aside(const JobRun& run);  // paused, and its task has returned
  void renew_leases();
  Expected<void> take_up_paused();
  void look_for_jobs(std::uint32_t limit);
  void look_at_others();
  void look_at(const Run& other);
  void tell_ends();
  // What the catalogue refuses, as it is away, is stored with the next beat. False where somebody
  // else has the job.
  bool store(const JobRecord& job);
  void store_again();
  std::optional<JobRecord> unstored(const JobId& id);

  JobCatalogue& catalogue_;
  const Log& events_;
  const JobTask task_;
  const TakenJobs taken_;
  std::function<void(const JobStatus&)> ended_;

  mutable std::mutex mutex_;                       // guards what follows
  std::map<JobId, Run> runs_;                      // the unfinished ones
  std::map<JobId, std::weak_ptr<JobRun>> others_;  // that somebody watches here
  std::vector<Run> again_;  // that could not be taken: the catalogue was away
  // When leases that have run out are believed: while the catalogue is away nobody can renew one.
  std::chrono::steady_clock::time_point believes_from_{};
  std::map<std::string, std::unique_ptr<Lane>> lanes_;
  bool stopping_ = false;

  std::mutex storing_;  // guards what follows
  std::map<JobId, JobRecord> unstored_;

  std::optional<Heart> heart_;
};

}  // namespace vitrine
