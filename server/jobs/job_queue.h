// SPDX-License-Identifier: Apache-2.0
// The queue of jobs and their states. Each scanner has a serial executor and at most one unfinished
// job. All other jobs share one more executor, on which their owners take turns. The catalogue
// stores all jobs, so that a restarted daemon continues its jobs and several daemons share the
// work. A daemon claims a job and renews the lease on it while it works. If another daemon claims
// the job, the first daemon abandons it.
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/auth/fair_queue.h"
#include "server/catalogue/jobs.h"
#include "server/jobs/periodic_task.h"
#include "server/jobs/serial_executor.h"
#include "server/log/log.h"

namespace vitrine::server {

// Why a running job is asked to stop.
enum class StopRequest : std::uint8_t {
  kNone,
  kPause,   // stop the work until the job is resumed
  kCancel,  // end the job; its results so far are kept
  kStop,    // stop the work, because the daemon ends
  kLost,    // abandon the job, because another daemon has claimed it
};

// How a task ended: kDone if the job is complete, kPutAside if the task followed a StopRequest and
// can continue later.
enum class JobEnd : std::uint8_t { kDone, kPutAside };

struct JobStatus {
  JobRecord record;
  std::optional<double> eta;  // remaining seconds
  std::string note;           // why the job waits, for example for a camera; usually empty

  bool operator==(const JobStatus&) const = default;
};

// A job while it runs: the interface between its task and the queue. Thread-safe.
class JobRun {
 public:
  explicit JobRun(JobRecord job) : status_{std::move(job), std::nullopt, {}} {}

  JobStatus status() const;  // may be called after the job has ended, too
  JobRecord job() const { return status().record; }
  StopRequest stop_request() const;
  // Returns the number of emergency stops of the scanner that had occurred when a client requested
  // or resumed the job.
  std::uint64_t stops_known() const;

  // Reports progress. `stage` is one word. `progress` is the completed share of the whole job, from
  // 0 to 1, and never decreases. `eta` is the remaining time in seconds, if known. `note` becomes
  // JobStatus::note.
  void report(std::string_view stage, double progress, std::optional<double> eta = {},
              std::string_view note = {});
  void made(const ModelId& model);
  void repaired(std::string repairs);  // records JobRecord::repairs
  // Resets the progress to 0, because the work so far has to be repeated.
  void restart();

  // Sets the job's note to `note`, an instruction to the operator, and waits until the job is
  // resumed. Meanwhile, the job is paused. Returns false if a stop is requested instead. If the
  // daemon ends, the job stays paused, and its task restarts after the job is resumed.
  bool await_resume(std::string_view stage, double progress, std::string_view note);

 private:
  friend class JobQueue;
  friend class Reaction;
  // Sets the function to call when a stop is requested, in place of the previous one. An empty
  // function removes it. On return, the previous function is no longer running.
  void when_asked(std::function<void()> react);
  void request_stop(StopRequest request, std::string_view reason = {});
  bool go_on();             // ends await_resume(); returns false if the job does not wait
  bool is_at_work() const;  // whether the job's task is still running

  mutable std::mutex mutex_;  // guards the members below
  JobStatus status_;
  StopRequest stop_request_ = StopRequest::kNone;
  bool waits_ = false;        // whether await_resume() is waiting
  std::string pause_reason_;  // reason of a kPause request; becomes the job's note
  std::condition_variable changed_;
  std::uint64_t stops_known_ = 0;
  std::function<void()> react_;

  // Called with the job's record each time the job enters another stage. Set before the task
  // starts.
  std::function<void(const JobRecord&)> entered_stage_;
};

// Calls `react` from another thread when a stop is requested, until this object is destroyed. If a
// stop was requested before, the constructor calls `react`. A run can have one Reaction at a time.
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

// A function that runs or continues one job. An error that it returns ends the job, unless a stop
// was requested meanwhile.
using JobTask = std::function<Expected<JobEnd>(JobRun& run)>;

// Selects the jobs that this daemon runs. All other jobs are left to other daemons.
struct TakenJobs {
  bool builds = true, scans = true;
  std::string holder = {};  // see Lease::holder
  std::function<bool(const std::string& scanner)> drives = [](const std::string&) { return true; };

  bool has(const JobRecord& job) const {
    return job.kind == JobKind::kPublish ? builds : scans && drives(job.scanner);
  }
};

// Thread-safe. All functions fail with kState if the job's state does not allow the call, and with
// kIo if the catalogue fails.
class JobQueue {
 public:
  JobQueue(JobCatalogue& catalogue, const Log& events, JobTask task, TakenJobs taken = {});
  ~JobQueue() { stop(); }

  // Sets the function that calls webhooks. The queue calls it with each job that has ended and has
  // a webhook. Call when_ended() before start(). Only one daemon calls the webhook of a job. If
  // that daemon ends before the call, another daemon makes the call ten minutes later.
  void when_ended(std::function<void(const JobStatus&)> ended) { ended_ = std::move(ended); }
  // Whether this daemon may still call the job's webhook. False if another daemon has called or
  // claimed the webhook meanwhile. Check this right before the call.
  bool may_notify(const JobId& id);

  // Continues the unfinished jobs of an earlier run of this daemon. Paused jobs stay paused. If the
  // daemon died during each of the last three runs of a job, ends the job: as done if its model was
  // stored, otherwise as failed. After this call, beat() runs twice per second until stop().
  Expected<void> start();

  // Renews the leases of the jobs that run in this daemon, receives cancellations, and looks for
  // jobs to run and webhooks to call.
  void beat();

  // Stops all running jobs so that they can continue later, and ends all executors.
  void stop();
  bool is_stopping() const;

  // Returns the job that a request with this idempotency key started, or nullopt if there is none.
  // Fails with kBadInput if the key was used for a different request.
  Expected<std::optional<JobRecord>> begun_by(const std::optional<IdempotencyKey>& key) const;

  // Adds a job and returns it. If the key was used for the same request before, returns the job of
  // that request. Fails with kBadInput if the key was used for a different request, and with kState
  // if the scanner is busy. `stops` becomes JobRun::stops_known().
  Expected<JobRecord> add(const JobRecord& job, const std::optional<ScanEntry>& scan,
                          const std::optional<IdempotencyKey>& key, std::uint64_t stops = 0);

  // Pauses a running job. `reason` says what the operator should do. The reason is the job's note
  // until the job is resumed or the daemon ends.
  Expected<JobStatus> pause(const JobId& id, std::string_view reason = {});
  Expected<JobStatus> resume(const JobId& id, std::uint64_t stops = 0);
  Expected<JobStatus> cancel(const JobId& id);

  // Returns nullopt if there is no such job.
  Expected<std::optional<JobStatus>> find(const JobId& id);
  Expected<std::vector<JobStatus>> list(const PageOf<JobId>& page);
  Expected<JobCounts> count() { return catalogue_.count_jobs(); }

  // Returns the run of an unfinished job of this daemon, or null. Its status can be read even after
  // the job has ended.
  std::shared_ptr<const JobRun> run(const JobId& id) const;
  // Returns the run of an unfinished job of any daemon, or null. Its status can be read even after
  // the job has ended. Changes by other daemons appear at the next beat().
  Expected<std::shared_ptr<const JobRun>> watch(const JobId& id);

  // Returns the unfinished job of a scanner, or nullopt.
  std::optional<JobStatus> job_of(const std::string& scanner) const;

  // Returns the oldest unfinished job of any daemon for which `is` returns true, or nullopt.
  Expected<std::optional<JobRecord>> job_where(const std::function<bool(const JobRecord&)>& is);

  // Posts a short command to the scanner's executor, which also runs the scanner's jobs. Fails with
  // kState if the scanner is busy; the command is then not run. A paused job makes the scanner busy
  // unless `beside_paused` is true.
  Expected<void> post_command(const std::string& scanner, std::function<void()> command,
                              bool beside_paused = false);

  // Returns the executor whose thread uses the scanner's devices.
  SerialExecutor& executor(const std::string& scanner);

 private:
  using SharedRun = std::shared_ptr<JobRun>;

  // The functions from here to the next blank line require that the caller holds mutex_.
  Expected<void> check_free(const std::string& scanner) const;
  Expected<SharedRun> unfinished(const JobId& id) const;
  SharedRun run_of(const std::string& scanner) const;
  void take_up(const JobRecord& job, std::uint64_t stops);
  void give_up(const SharedRun& run);
  void post(const SharedRun& run);
  SharedRun next_without_scanner();
  // Returns false if another daemon has claimed the job.
  bool set_state(const SharedRun& run, JobState state);
  void lose(const SharedRun& run);
  bool take(const SharedRun& run);
  SerialExecutor& executor_of(const std::string& name);

  void work(const SharedRun& run);
  static JobState state_after(JobRun& run, const Expected<JobEnd>& result);
  void end(const SharedRun& run, const Expected<JobEnd>& result);
  static bool is_aside(const JobRun& run);  // whether the job is paused and its task has returned
  void renew_leases();
  Expected<void> take_up_paused();
  void look_for_jobs(std::uint32_t limit);
  void look_at_others();
  void look_at(const SharedRun& other);
  void call_webhooks();
  // Stores the record in the catalogue. If the catalogue is unreachable, the next beat() tries
  // again. Returns false if another daemon has claimed the job.
  bool store(const JobRecord& job);
  void store_again();
  std::optional<JobRecord> unstored(const JobId& id);

  JobCatalogue& catalogue_;
  const Log& events_;
  const JobTask task_;
  const TakenJobs taken_;
  std::function<void(const JobStatus&)> ended_;

  mutable std::mutex mutex_;                       // guards the members up to is_stopping_
  std::map<JobId, SharedRun> runs_;                // unfinished jobs
  std::map<JobId, std::weak_ptr<JobRun>> others_;  // jobs of other daemons that watch() returned
  // the jobs that wait for the executor of jobs without a scanner
  FairQueue<SharedRun> without_scanner_;
  std::vector<SharedRun> again_;  // jobs to claim when the catalogue is reachable again
  // Until this time, expired leases of other daemons still count as valid, because these daemons
  // could not renew them while the catalogue was unreachable.
  std::chrono::steady_clock::time_point believes_from_{};
  std::map<std::string, std::unique_ptr<SerialExecutor>> executors_;
  bool is_stopping_ = false;

  std::mutex storing_;  // guards unstored_
  std::map<JobId, JobRecord> unstored_;

  std::optional<PeriodicTask> lease_renewal_;
};

}  // namespace vitrine::server
