// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_queue.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "server/jobs/clock.h"

namespace vitrine::server {
namespace {

// Returns the name of the executor that runs the job. All jobs that need no scanner share one
// executor.
std::string executor_name(const JobRecord& job) {
  return needs_scanner(job.kind) ? job.scanner : "";
}

constexpr std::uint32_t kMaxAttempts = 3;
constexpr std::chrono::milliseconds kBeat{500};
constexpr std::chrono::seconds kLease{15};
// Duration of a daemon's claim on the webhook of a job. Afterwards, another daemon may call the
// webhook.
constexpr std::chrono::minutes kWebhookTimeout{10};
constexpr std::uint32_t kAtATime = 128;  // largest number of jobs that one search finds

std::vector<JobKind> kinds_of(const TakenJobs& taken) {
  std::vector<JobKind> kinds;
  if (taken.builds) kinds.push_back(JobKind::kPublish);
  if (taken.scans)
    kinds.insert(kinds.end(), {JobKind::kScan, JobKind::kCalibrate, JobKind::kReprocess});
  return kinds;
}

// Whether the daemon died during each of the job's last kMaxAttempts runs. The job may then be the
// cause.
bool is_hopeless(const JobRecord& job) {
  return job.state == JobState::kRunning && job.attempts >= kMaxAttempts;
}

Unexpected stopping() {
  return fail(ErrorCode::kState, "the daemon is stopping; try again later");
}

Unexpected not_now(const JobRecord& job, std::string_view what) {
  return fail(ErrorCode::kState,
              fmt::format("job {} {}; look at its state", job.id.to_string(), what));
}

}  // namespace

JobQueue::JobQueue(JobCatalogue& catalogue, const Log& events, JobTask task, TakenJobs taken)
    : catalogue_(catalogue), events_(events), task_(std::move(task)), taken_(std::move(taken)) {}

Expected<void> JobQueue::start() {
  if (auto dropped = catalogue_.drop_leases(taken_.holder); !dropped) return dropped;
  if (auto taken = take_up_paused(); !taken) return taken;
  {
    const std::scoped_lock lock(mutex_);
    believes_from_ = std::chrono::steady_clock::now() + kLease;
  }
  look_for_jobs(UINT32_MAX);
  call_webhooks();
  lease_renewal_.emplace(kBeat, events_, [this] { beat(); });
  return {};
}

void JobQueue::beat() {
  store_again();
  renew_leases();
  static_cast<void>(take_up_paused());
  look_for_jobs(kAtATime);
  look_at_others();
  call_webhooks();
}

void JobQueue::stop() {
  std::map<std::string, std::unique_ptr<SerialExecutor>> executors;
  {
    const std::scoped_lock lock(mutex_);
    is_stopping_ = true;
    for (const auto& [id, run] : runs_)
      run->request_stop(StopRequest::kStop);
    executors.swap(executors_);
  }
  for (const auto& [name, executor] : executors)
    executor->finish();
  lease_renewal_.reset();  // reset last, so that jobs that stop slowly keep their leases
}

bool JobQueue::is_stopping() const {
  const std::scoped_lock lock(mutex_);
  return is_stopping_;
}

void JobQueue::take_up(const JobRecord& job, std::uint64_t stops) {
  const SharedRun run = std::make_shared<JobRun>(job);
  run->stops_known_ = stops;
  run->entered_stage_ = [this](const JobRecord& now) { static_cast<void>(store(now)); };
  runs_[job.id] = run;
  if (is_hopeless(job)) return give_up(run);
  if (job.state == JobState::kPaused) return;
  run->status_.record.state = JobState::kQueued;
  post(run);
}

// Ends a hopeless job (is_hopeless()): as done if the job's model was stored before the daemon
// died, otherwise as failed. First claims the job, so that no daemon that still runs it can change
// it.
void JobQueue::give_up(const SharedRun& run) {
  const auto taken = catalogue_.claim(run->job().id, {taken_.holder, kLease});
  if (!taken || !*taken) return lose(run);
  const bool is_complete = (*taken)->model.has_value();
  {
    const std::scoped_lock lock(run->mutex_);
    run->status_.record = **taken;
    if (!is_complete) {
      run->status_.record.error = fmt::format(
          "the daemon died {} times while running this job; see its log, then start the job again",
          kMaxAttempts);
    }
  }
  set_state(run, is_complete ? JobState::kDone : JobState::kFailed);
}

void JobQueue::post(const SharedRun& run) {
  const JobRecord job = run->job();
  const std::string name = executor_name(job);
  if (!name.empty()) return executor_of(name).post([this, run] { work(run); });
  without_scanner_.push(job.owner, run);
  executor_of(name).post([this] { work(next_without_scanner()); });
}

// Returns the next job that needs no scanner. Such a job always exists, because post() posts one
// call of this function for each waiting job.
JobQueue::SharedRun JobQueue::next_without_scanner() {
  const std::scoped_lock lock(mutex_);
  return *without_scanner_.take();
}

Expected<std::optional<JobRecord>> JobQueue::begun_by(
    const std::optional<IdempotencyKey>& key) const {
  if (!key) return std::nullopt;
  const auto earlier = catalogue_.find_key(key->key);
  if (!earlier) return tl::unexpected(earlier.error());
  if (!*earlier) return std::nullopt;
  if ((*earlier)->request != key->request) {
    return fail(ErrorCode::kBadInput,
                "the key was used for another request; give each request a key of its own");
  }
  return catalogue_.find_job((*earlier)->job);
}

Expected<JobRecord> JobQueue::add(const JobRecord& job, const std::optional<ScanEntry>& scan,
                                  const std::optional<IdempotencyKey>& key, std::uint64_t stops) {
  const std::scoped_lock lock(mutex_);
  const auto earlier = begun_by(key);
  if (!earlier) return tl::unexpected(earlier.error());
  if (*earlier) return **earlier;
  if (is_stopping_) return stopping();
  if (needs_scanner(job.kind)) {
    if (auto is_free = check_free(job.scanner); !is_free) return tl::unexpected(is_free.error());
  }
  if (auto added = catalogue_.add(job, scan, key); !added) return tl::unexpected(added.error());
  if (taken_.has(job)) take_up(job, stops);
  return job;
}

Expected<void> JobQueue::check_free(const std::string& scanner) const {
  const SharedRun busy = run_of(scanner);
  if (!busy) return {};
  return fail(ErrorCode::kState,
              fmt::format("scanner {} is busy with job {}; wait for its end or cancel it", scanner,
                          busy->job().id.to_string()));
}

Expected<void> JobQueue::post_command(const std::string& scanner, std::function<void()> command,
                                      bool beside_paused) {
  const std::scoped_lock lock(mutex_);
  if (is_stopping_) return stopping();
  const SharedRun busy = run_of(scanner);
  const bool is_beside = beside_paused && busy && is_aside(*busy);
  if (auto is_free = check_free(scanner); !is_free && !is_beside) return is_free;
  executor_of(scanner).post(std::move(command));
  return {};
}

Expected<JobQueue::SharedRun> JobQueue::unfinished(const JobId& id) const {
  const auto found = runs_.find(id);
  if (found != runs_.end()) return found->second;
  const auto job = catalogue_.find_job(id);
  if (!job) return tl::unexpected(job.error());
  if (*job && !has_ended((*job)->state)) return not_now(**job, "is another daemon's");
  return fail(ErrorCode::kState, fmt::format("job {} has ended; start another", id.to_string()));
}

JobQueue::SharedRun JobQueue::run_of(const std::string& scanner) const {
  for (const auto& [id, run] : runs_) {
    const JobRecord job = run->job();
    if (needs_scanner(job.kind) && job.scanner == scanner) return run;
  }
  return nullptr;
}

std::shared_ptr<const JobRun> JobQueue::run(const JobId& id) const {
  const std::scoped_lock lock(mutex_);
  const auto found = runs_.find(id);
  return found == runs_.end() ? nullptr : found->second;
}

Expected<std::shared_ptr<const JobRun>> JobQueue::watch(const JobId& id) {
  if (auto own = run(id)) return own;
  const auto job = catalogue_.find_job(id);
  if (!job) return tl::unexpected(job.error());
  if (!*job || has_ended((*job)->state)) return nullptr;
  const std::scoped_lock lock(mutex_);
  SharedRun other = others_[id].lock();
  if (!other) others_[id] = other = std::make_shared<JobRun>(**job);
  return other;
}

std::optional<JobStatus> JobQueue::job_of(const std::string& scanner) const {
  const std::scoped_lock lock(mutex_);
  const SharedRun run = run_of(scanner);
  return run ? std::optional(run->status()) : std::nullopt;
}

Expected<std::optional<JobRecord>> JobQueue::job_where(
    const std::function<bool(const JobRecord&)>& is) {
  store_again();
  auto jobs = catalogue_.unfinished_jobs();
  if (!jobs) return tl::unexpected(jobs.error());
  const auto found = std::ranges::find_if(*jobs, is);
  return found == jobs->end() ? std::nullopt : std::optional(std::move(*found));
}

bool JobQueue::set_state(const SharedRun& run, JobState state) {
  JobStatus next = run->status();
  next.record.state = state;
  next.eta.reset();
  if (has_ended(state)) next.record.ended = now_in_milliseconds();
  if (state == JobState::kDone) next.record.progress = 1;
  if (!store(next.record)) {
    lose(run);
    return false;
  }
  {
    const std::scoped_lock lock(run->mutex_);
    if (state == JobState::kQueued) {
      run->stop_request_ = StopRequest::kNone;
      run->pause_reason_.clear();
    }
    next.note = state == JobState::kPaused ? run->pause_reason_ : "";
    run->status_ = std::move(next);
  }
  if (!has_ended(state)) return true;
  runs_.erase(run->job().id);
  call_webhooks();
  return true;
}

// Abandons a job that another daemon has claimed. Clients of this daemon that watch the job still
// receive its progress.
void JobQueue::lose(const SharedRun& run) {
  const JobId id = run->job().id;
  runs_.erase(id);
  others_[id] = run;
}

Expected<JobStatus> JobQueue::pause(const JobId& id, std::string_view reason) {
  const std::scoped_lock lock(mutex_);
  const auto run = unfinished(id);
  if (!run) return tl::unexpected(run.error());
  const JobRecord job = (*run)->job();
  if (job.state == JobState::kPaused) return not_now(job, "is paused already");
  (*run)->request_stop(StopRequest::kPause, reason);
  if (job.state == JobState::kQueued && !set_state(*run, JobState::kPaused))
    return not_now(job, "was claimed or ended meanwhile");
  return (*run)->status();
}

Expected<JobStatus> JobQueue::resume(const JobId& id, std::uint64_t stops) {
  const std::scoped_lock lock(mutex_);
  const auto run = unfinished(id);
  if (!run) return tl::unexpected(run.error());
  const JobRecord job = (*run)->job();
  if (job.state != JobState::kPaused) return not_now(job, "is not paused");
  if (is_stopping_) return stopping();
  {
    const std::scoped_lock inner((*run)->mutex_);
    (*run)->stops_known_ = stops;
  }
  if ((*run)->go_on()) {
    store((*run)->job());
  } else if (set_state(*run, JobState::kQueued)) {
    post(*run);
  } else {
    return not_now(job, "was claimed or ended meanwhile");
  }
  return (*run)->status();
}

Expected<JobStatus> JobQueue::cancel(const JobId& id) {
  const std::scoped_lock lock(mutex_);
  const auto found = runs_.find(id);
  const SharedRun run = found == runs_.end() ? nullptr : found->second;
  if (run && run->is_at_work() && run->stop_request() != StopRequest::kLost) {
    run->request_stop(StopRequest::kCancel);
    return run->status();
  }
  const auto cancelled = catalogue_.cancel(id, now_in_milliseconds());
  if (!cancelled) return tl::unexpected(cancelled.error());
  const JobStatus status{*cancelled, std::nullopt, {}};
  if (!has_ended(status.record.state)) return status;
  if (run) {
    const std::scoped_lock inner(run->mutex_);
    run->status_ = status;
  }
  runs_.erase(id);
  call_webhooks();
  return status;
}

Expected<std::optional<JobStatus>> JobQueue::find(const JobId& id) {
  if (const auto unfinished = run(id)) return unfinished->status();
  store_again();
  if (const auto waiting = unstored(id)) return JobStatus{*waiting, std::nullopt, {}};
  const auto stored = catalogue_.find_job(id);
  if (!stored) return tl::unexpected(stored.error());
  if (!*stored) return std::nullopt;
  return JobStatus{**stored, std::nullopt, {}};
}

Expected<std::vector<JobStatus>> JobQueue::list(const PageOf<JobId>& page) {
  store_again();
  const auto stored = catalogue_.jobs(page);
  if (!stored) return tl::unexpected(stored.error());
  std::vector<JobStatus> jobs;
  for (const JobRecord& job : *stored) {
    const auto now = find(job.id);
    if (!now) return tl::unexpected(now.error());
    if (*now) jobs.push_back(**now);
  }
  return jobs;
}

SerialExecutor& JobQueue::executor(const std::string& scanner) {
  const std::scoped_lock lock(mutex_);
  return executor_of(scanner);
}

SerialExecutor& JobQueue::executor_of(const std::string& name) {
  auto& executor = executors_[name];
  if (!executor) executor = std::make_unique<SerialExecutor>(events_);
  return *executor;
}

// Claims a queued job. Returns false if the job cannot run now, for example because another daemon
// has claimed it.
bool JobQueue::take(const SharedRun& run) {
  const std::scoped_lock lock(mutex_);
  if (is_stopping_ || run->job().state != JobState::kQueued) return false;
  const auto taken = catalogue_.claim(run->job().id, {taken_.holder, kLease});
  if (!taken) {
    events_.event(Severity::kError, taken.error().message);
    again_.push_back(run);
    return false;
  }
  if (!*taken) {
    lose(run);
    return false;
  }
  const std::scoped_lock inner(run->mutex_);
  run->status_ = {**taken, std::nullopt, {}};
  return true;
}

void JobQueue::work(const SharedRun& run) {
  if (!take(run)) return;
  Expected<JobEnd> result = JobEnd::kDone;
  try {
    result = task_(*run);
  } catch (const std::exception& fault) {  // for example std::bad_alloc; only this job fails
    result = fail(ErrorCode::kIo, fault.what());
  }
  end(run, result);
}

// Returns the new state of a job whose task has returned. If the job has failed, sets the error in
// its record.
JobState JobQueue::state_after(JobRun& run, const Expected<JobEnd>& result) {
  const StopRequest request = run.stop_request();
  if (result && *result == JobEnd::kDone) return JobState::kDone;
  if (request == StopRequest::kCancel) return JobState::kCancelled;
  // After a request to pause, only the error kState is expected. Any other error makes the job
  // fail, so that the error is reported; a failed scan can be resumed, too.
  const bool is_put_aside = result || result.error().code == ErrorCode::kState;
  if (request == StopRequest::kPause && is_put_aside) return JobState::kPaused;
  if (request == StopRequest::kStop) return JobState::kQueued;  // runs again after a restart
  const std::scoped_lock lock(run.mutex_);
  run.status_.record.error =
      result ? "the job stopped without a request; start it again" : result.error().message;
  return JobState::kFailed;
}

void JobQueue::end(const SharedRun& run, const Expected<JobEnd>& result) {
  const std::scoped_lock lock(mutex_);
  const StopRequest request = run->stop_request();
  if (request == StopRequest::kLost) return lose(run);
  {
    const std::scoped_lock inner(run->mutex_);
    run->status_.record.attempts = 0;
  }
  set_state(run, state_after(*run, result));
}

void JobQueue::renew_leases() {
  std::vector<SharedRun> runs;
  {
    const std::scoped_lock lock(mutex_);
    for (const auto& [id, run] : runs_) {
      if (run->is_at_work()) runs.push_back(run);
    }
  }
  for (const SharedRun& run : runs) {
    const JobRecord job = run->job();
    const auto wanted = catalogue_.renew(job, kLease);
    const std::scoped_lock lock(mutex_);
    const bool is_same = run->is_at_work() && run->job().fence == job.fence;
    if (!is_same) continue;
    if (wanted && *wanted) run->request_stop(StopRequest::kCancel);
    if (wanted || wanted.error().code != ErrorCode::kState) continue;
    events_.event(Severity::kWarning, wanted.error().message);
    run->request_stop(StopRequest::kLost);
  }
}

bool JobQueue::is_aside(const JobRun& run) {
  return run.job().state == JobState::kPaused && !run.is_at_work();
}

// Adds the paused jobs that this daemon must run, including those of scanners that it has acquired
// recently. Reads each job again while it holds mutex_, because another daemon may have resumed or
// ended the job meanwhile.
Expected<void> JobQueue::take_up_paused() {
  const auto paused = catalogue_.paused_jobs();
  if (!paused) return tl::unexpected(paused.error());
  const std::scoped_lock lock(mutex_);
  for (const JobRecord& job : *paused) {
    const bool is_new = !runs_.contains(job.id) && !unstored(job.id);
    if (is_stopping_ || !is_new || !taken_.has(job)) continue;
    const auto now = catalogue_.find_job(job.id);
    if (now && *now && (*now)->state == JobState::kPaused) take_up(**now, 0);
  }
  return {};
}

// Looks for at most `limit` jobs to run. After the catalogue was unreachable, takes no jobs with
// expired leases for the duration of one lease, because the daemons that run these jobs may have
// been unable to renew the leases.
void JobQueue::look_for_jobs(std::uint32_t limit) {
  const auto believes_from = [this] {
    const std::scoped_lock lock(mutex_);
    return believes_from_;
  }();
  const bool overdue = std::chrono::steady_clock::now() >= believes_from;
  const auto waiting = catalogue_.waiting_jobs(kinds_of(taken_), limit, overdue);
  const std::scoped_lock lock(mutex_);
  if (!waiting) believes_from_ = std::chrono::steady_clock::now() + kLease;
  if (is_stopping_ || !waiting) return;
  for (const SharedRun& run : std::exchange(again_, {}))
    post(run);
  for (const JobRecord& job : *waiting) {
    if (!runs_.contains(job.id) && !unstored(job.id) && taken_.has(job)) take_up(job, 0);
  }
}

void JobQueue::look_at_others() {
  std::vector<SharedRun> others;
  {
    const std::scoped_lock lock(mutex_);
    std::erase_if(others_, [](const auto& other) { return other.second.expired(); });
    for (const auto& [id, other] : others_) {
      if (SharedRun run = other.lock()) others.push_back(std::move(run));
    }
    // Also updates this daemon's paused jobs, because another daemon may cancel or claim them.
    for (const auto& [id, run] : runs_) {
      if (is_aside(*run)) others.push_back(run);
    }
  }
  for (const SharedRun& other : others)
    look_at(other);
}

void JobQueue::look_at(const SharedRun& other) {
  const auto job = catalogue_.find_job(other->job().id);
  if (!job || !*job) return;
  const std::scoped_lock lock(mutex_);
  const JobId id = (*job)->id;
  JobStatus now{**job, std::nullopt, {}};
  if (has_ended((*job)->state)) {
    others_.erase(id);
    runs_.erase(id);
  } else if (const auto own = runs_.find(id); own != runs_.end()) {
    if (own->second != other) {
      now = own->second->status();  // this daemon has claimed the job since the last update
    } else {
      if (!is_aside(*other) || taken_.has(**job)) return;
      lose(other);  // another daemon drives the scanner now
    }
  }
  const std::scoped_lock inner(other->mutex_);
  other->status_ = std::move(now);
}

void JobQueue::call_webhooks() {
  if (!ended_) return;
  const auto ends = catalogue_.claim_unnotified({taken_.holder, kWebhookTimeout});
  if (!ends) return;
  for (const JobRecord& job : *ends)
    ended_(JobStatus{job, std::nullopt, {}});
}

bool JobQueue::may_notify(const JobId& id) {
  const auto renewed = catalogue_.renew_unnotified(id, {taken_.holder, kWebhookTimeout});
  return renewed || renewed.error().code != ErrorCode::kState;
}

bool JobQueue::store(const JobRecord& job) {
  const std::scoped_lock lock(storing_);
  unstored_.erase(job.id);
  const auto stored = catalogue_.update(job);
  if (stored) return true;
  events_.event(Severity::kError, stored.error().message);
  if (stored.error().code == ErrorCode::kState) return false;
  unstored_[job.id] = job;
  return true;
}

void JobQueue::store_again() {
  const std::scoped_lock lock(storing_);
  while (!unstored_.empty()) {
    const auto stored = catalogue_.update(unstored_.begin()->second);
    if (!stored) events_.event(Severity::kError, stored.error().message);
    if (!stored && stored.error().code != ErrorCode::kState) return;
    unstored_.erase(unstored_.begin());
  }
}

std::optional<JobRecord> JobQueue::unstored(const JobId& id) {
  const std::scoped_lock lock(storing_);
  const auto found = unstored_.find(id);
  return found == unstored_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace vitrine::server
