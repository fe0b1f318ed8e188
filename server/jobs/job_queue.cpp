// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_queue.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "server/jobs/clock.h"

namespace vitrine {
namespace {

// Jobs that need no device share a lane.
std::string lane_name(const JobRecord& job) {
  return needs_scanner(job.kind) ? job.scanner : "";
}

constexpr std::uint32_t kMaxAttempts = 3;
constexpr std::chrono::milliseconds kBeat{500};
constexpr std::chrono::seconds kLease{15};
constexpr std::chrono::minutes kTelling{10};  // in which a webhook is told, or given up
constexpr std::uint32_t kAtATime = 16;        // jobs that are looked for

std::vector<JobKind> kinds_of(const TakenJobs& taken) {
  std::vector<JobKind> kinds;
  if (taken.builds) kinds.push_back(JobKind::kPublish);
  if (taken.scans)
    kinds.insert(kinds.end(), {JobKind::kScan, JobKind::kCalibrate, JobKind::kReprocess});
  return kinds;
}

// It ran when a daemon died, and the two before that as well: it may be what they died of.
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
  tell_ends();
  heart_.emplace(kBeat, events_, [this] { beat(); });
  return {};
}

void JobQueue::beat() {
  store_again();
  renew_leases();
  static_cast<void>(take_up_paused());
  look_for_jobs(kAtATime);
  look_at_others();
  tell_ends();
}

void JobQueue::stop() {
  std::map<std::string, std::unique_ptr<Lane>> lanes;
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
    for (const auto& [id, run] : runs_)
      run->ask(JobWish::kStop);
    lanes.swap(lanes_);
  }
  for (const auto& [name, lane] : lanes)
    lane->finish();
  heart_.reset();  // what ends slowly is held until then
}

bool JobQueue::is_stopping() const {
  const std::scoped_lock lock(mutex_);
  return stopping_;
}

void JobQueue::take_up(const JobRecord& job, std::uint64_t stops) {
  const Run run = std::make_shared<JobRun>(job);
  run->stops_known_ = stops;
  run->entered_stage_ = [this](const JobRecord& now) { static_cast<void>(store(now)); };
  runs_[job.id] = run;
  if (is_hopeless(job)) return give_up(run);
  if (job.state == JobState::kPaused) return;
  run->status_.record.state = JobState::kQueued;
  post(run);
}

// Taken first, so that whoever may be at it still has no say in it any more.
void JobQueue::give_up(const Run& run) {
  const auto taken = catalogue_.claim(run->job().id, {taken_.holder, kLease});
  if (!taken || !*taken) return lose(run);
  {
    const std::scoped_lock lock(run->mutex_);
    run->status_.record = **taken;
    run->status_.record.error = fmt::format(
        "the daemon died {} times at work on this; look into its log, then start it again",
        kMaxAttempts);
  }
  set_state(run, JobState::kFailed);
}

void JobQueue::post(const Run& run) {
  lane_of(lane_name(run->job())).post([this, run] { work(run); });
}

Expected<std::optional<JobRecord>> JobQueue::begun_by(const std::optional<OnceKey>& once) const {
  if (!once) return std::nullopt;
  const auto earlier = catalogue_.find_once(once->key);
  if (!earlier) return Unexpected(earlier.error());
  if (!*earlier) return std::nullopt;
  if ((*earlier)->request != once->request) {
    return fail(ErrorCode::kBadInput,
                "the key was used for another request; give each request a key of its own");
  }
  return catalogue_.find_job((*earlier)->job);
}

Expected<JobRecord> JobQueue::add(const JobRecord& job, const std::optional<ScanEntry>& scan,
                                  const std::optional<OnceKey>& once, std::uint64_t stops) {
  const std::scoped_lock lock(mutex_);
  const auto earlier = begun_by(once);
  if (!earlier) return Unexpected(earlier.error());
  if (*earlier) return **earlier;
  if (stopping_) return stopping();
  if (needs_scanner(job.kind)) {
    if (auto is_free = check_free(job.scanner); !is_free) return Unexpected(is_free.error());
  }
  if (auto added = catalogue_.add(job, scan, once); !added) return Unexpected(added.error());
  if (taken_.has(job)) take_up(job, stops);
  return job;
}

Expected<void> JobQueue::check_free(const std::string& scanner) const {
  const Run busy = run_of(scanner);
  if (!busy) return {};
  return fail(ErrorCode::kState,
              fmt::format("scanner {} is busy with job {}; wait for its end or cancel it", scanner,
                          busy->job().id.to_string()));
}

Expected<void> JobQueue::post_command(const std::string& scanner, std::function<void()> command,
                                      bool beside_paused) {
  const std::scoped_lock lock(mutex_);
  if (stopping_) return stopping();
  const Run busy = run_of(scanner);
  const bool is_beside = beside_paused && busy && is_aside(*busy);
  if (auto is_free = check_free(scanner); !is_free && !is_beside) return is_free;
  lane_of(scanner).post(std::move(command));
  return {};
}

Expected<JobQueue::Run> JobQueue::unfinished(const JobId& id) const {
  const auto found = runs_.find(id);
  if (found != runs_.end()) return found->second;
  const auto job = catalogue_.find_job(id);
  if (!job) return Unexpected(job.error());
  if (*job && !has_ended((*job)->state)) return not_now(**job, "is another daemon's");
  return fail(ErrorCode::kState, fmt::format("job {} has ended; start another", id.to_string()));
}

JobQueue::Run JobQueue::run_of(const std::string& scanner) const {
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
  if (!job) return Unexpected(job.error());
  if (!*job || has_ended((*job)->state)) return nullptr;
  const std::scoped_lock lock(mutex_);
  Run other = others_[id].lock();
  if (!other) others_[id] = other = std::make_shared<JobRun>(**job);
  return other;
}

std::optional<JobStatus> JobQueue::job_of(const std::string& scanner) const {
  const std::scoped_lock lock(mutex_);
  const Run run = run_of(scanner);
  return run ? std::optional(run->status()) : std::nullopt;
}

Expected<std::optional<JobRecord>> JobQueue::job_where(
    const std::function<bool(const JobRecord&)>& is) {
  store_again();
  auto jobs = catalogue_.unfinished_jobs();
  if (!jobs) return Unexpected(jobs.error());
  const auto found = std::ranges::find_if(*jobs, is);
  return found == jobs->end() ? std::nullopt : std::optional(std::move(*found));
}

bool JobQueue::set_state(const Run& run, JobState state) {
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
      run->wish_ = JobWish::kNone;
      run->pause_reason_.clear();
    }
    next.note = state == JobState::kPaused ? run->pause_reason_ : "";
    run->status_ = std::move(next);
  }
  if (!has_ended(state)) return true;
  runs_.erase(run->job().id);
  tell_ends();
  return true;
}

// Whoever watches it goes on to see what becomes of it.
void JobQueue::lose(const Run& run) {
  const JobId id = run->job().id;
  runs_.erase(id);
  others_[id] = run;
}

Expected<JobStatus> JobQueue::pause(const JobId& id, std::string_view reason) {
  const std::scoped_lock lock(mutex_);
  const auto run = unfinished(id);
  if (!run) return Unexpected(run.error());
  const JobRecord job = (*run)->job();
  if (job.state == JobState::kPaused) return not_now(job, "is paused already");
  (*run)->ask(JobWish::kPause, reason);
  if (job.state == JobState::kQueued && !set_state(*run, JobState::kPaused))
    return not_now(job, "has been taken or ended meanwhile");
  return (*run)->status();
}

Expected<JobStatus> JobQueue::resume(const JobId& id, std::uint64_t stops) {
  const std::scoped_lock lock(mutex_);
  const auto run = unfinished(id);
  if (!run) return Unexpected(run.error());
  const JobRecord job = (*run)->job();
  if (job.state != JobState::kPaused) return not_now(job, "is not paused");
  if (stopping_) return stopping();
  {
    const std::scoped_lock inner((*run)->mutex_);
    (*run)->stops_known_ = stops;
  }
  if ((*run)->go_on()) {
    store((*run)->job());
  } else if (set_state(*run, JobState::kQueued)) {
    post(*run);
  } else {
    return not_now(job, "has been taken or ended meanwhile");
  }
  return (*run)->status();
}

Expected<JobStatus> JobQueue::cancel(const JobId& id) {
  const std::scoped_lock lock(mutex_);
  const auto found = runs_.find(id);
  const Run run = found == runs_.end() ? nullptr : found->second;
  if (run && run->is_at_work() && run->wish() != JobWish::kLost) {
    run->ask(JobWish::kCancel);
    return run->status();
  }
  const auto cancelled = catalogue_.cancel(id, now_in_milliseconds());
  if (!cancelled) return Unexpected(cancelled.error());
  const JobStatus status{*cancelled, std::nullopt, {}};
  if (!has_ended(status.record.state)) return status;
  if (run) {
    const std::scoped_lock inner(run->mutex_);
    run->status_ = status;
  }
  runs_.erase(id);
  tell_ends();
  return status;
}

Expected<std::optional<JobStatus>> JobQueue::find(const JobId& id) {
  if (const auto unfinished = run(id)) return unfinished->status();
  store_again();
  if (const auto waiting = unstored(id)) return JobStatus{*waiting, std::nullopt, {}};
  const auto stored = catalogue_.find_job(id);
  if (!stored) return Unexpected(stored.error());
  if (!*stored) return std::nullopt;
  return JobStatus{**stored, std::nullopt, {}};
}

Expected<std::vector<JobStatus>> JobQueue::list(const PageOf& page) {
  store_again();
  const auto stored = catalogue_.jobs(page);
  if (!stored) return Unexpected(stored.error());
  std::vector<JobStatus> jobs;
  for (const JobRecord& job : *stored) {
    const auto now = find(job.id);
    if (!now) return Unexpected(now.error());
    if (*now) jobs.push_back(**now);
  }
  return jobs;
}

Lane& JobQueue::lane(const std::string& scanner) {
  const std::scoped_lock lock(mutex_);
  return lane_of(scanner);
}

Lane& JobQueue::lane_of(const std::string& name) {
  auto& lane = lanes_[name];
  if (!lane) lane = std::make_unique<Lane>(events_);
  return *lane;
}

// Begins it, unless somebody else has.
bool JobQueue::take(const Run& run) {
  const std::scoped_lock lock(mutex_);
  if (stopping_ || run->job().state != JobState::kQueued) return false;
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

void JobQueue::work(const Run& run) {
  if (!take(run)) return;
  Expected<JobEnd> result = JobEnd::kDone;
  try {
    result = task_(*run);
  } catch (const std::exception& fault) {  // out of memory: this job ends, the daemon goes on
    result = fail(ErrorCode::kIo, fault.what());
  }
  end(run, result);
}

// Of a job that has come to an end here, and why where it has failed.
JobState JobQueue::state_after(JobRun& run, const Expected<JobEnd>& result) {
  const JobWish wish = run.wish();
  if (result && *result == JobEnd::kDone) return JobState::kDone;
  if (wish == JobWish::kCancel) return JobState::kCancelled;
  // What a scan says of itself meanwhile must not go under; a failed one is resumed as well.
  const bool is_put_aside = result || result.error().code == ErrorCode::kState;
  if (wish == JobWish::kPause && is_put_aside) return JobState::kPaused;
  if (wish == JobWish::kStop) return JobState::kQueued;  // goes on at the next start
  const std::scoped_lock lock(run.mutex_);
  run.status_.record.error = result ? "the job was put aside unasked" : result.error().message;
  return JobState::kFailed;
}

void JobQueue::end(const Run& run, const Expected<JobEnd>& result) {
  const std::scoped_lock lock(mutex_);
  const JobWish wish = run->wish();
  if (wish == JobWish::kLost) return lose(run);
  {
    const std::scoped_lock inner(run->mutex_);
    run->status_.record.attempts = 0;
  }
  set_state(run, state_after(*run, result));
}

void JobQueue::renew_leases() {
  std::vector<Run> runs;
  {
    const std::scoped_lock lock(mutex_);
    for (const auto& [id, run] : runs_) {
      if (run->is_at_work()) runs.push_back(run);
    }
  }
  for (const Run& run : runs) {
    const JobRecord job = run->job();
    const auto wanted = catalogue_.renew(job, kLease);
    const std::scoped_lock lock(mutex_);
    const bool is_same = run->is_at_work() && run->job().fence == job.fence;
    if (!is_same) continue;
    if (wanted && *wanted) run->ask(JobWish::kCancel);
    if (wanted || wanted.error().code != ErrorCode::kState) continue;
    events_.event(Severity::kWarning, wanted.error().message);
    run->ask(JobWish::kLost);
  }
}

bool JobQueue::is_aside(const JobRun& run) {
  return run.job().state == JobState::kPaused && !run.is_at_work();
}

// Those of a scanner that this daemon has come to drive, too. A job is looked at again under the
// lock: it may have gone on since, or ended.
Expected<void> JobQueue::take_up_paused() {
  const auto paused = catalogue_.paused_jobs();
  if (!paused) return Unexpected(paused.error());
  const std::scoped_lock lock(mutex_);
  for (const JobRecord& job : *paused) {
    const bool is_new = !runs_.contains(job.id) && !unstored(job.id);
    if (stopping_ || !is_new || !taken_.has(job)) continue;
    const auto now = catalogue_.find_job(job.id);
    if (now && *now && (*now)->state == JobState::kPaused) take_up(**now, 0);
  }
  return {};
}

// Who holds a job and could not reach the catalogue either has the time of a lease to come back.
void JobQueue::look_for_jobs(std::uint32_t limit) {
  const auto believes_from = [this] {
    const std::scoped_lock lock(mutex_);
    return believes_from_;
  }();
  const bool overdue = std::chrono::steady_clock::now() >= believes_from;
  const auto waiting = catalogue_.waiting_jobs(kinds_of(taken_), limit, overdue);
  const std::scoped_lock lock(mutex_);
  if (!waiting) believes_from_ = std::chrono::steady_clock::now() + kLease;
  if (stopping_ || !waiting) return;
  for (const Run& run : std::exchange(again_, {}))
    post(run);
  for (const JobRecord& job : *waiting) {
    if (!runs_.contains(job.id) && !unstored(job.id) && taken_.has(job)) take_up(job, 0);
  }
}

void JobQueue::look_at_others() {
  std::vector<Run> others;
  {
    const std::scoped_lock lock(mutex_);
    std::erase_if(others_, [](const auto& other) { return other.second.expired(); });
    for (const auto& [id, other] : others_) {
      if (Run run = other.lock()) others.push_back(std::move(run));
    }
    for (const auto& [id, run] : runs_) {  // what is put aside others may cancel, or take over
      if (is_aside(*run)) others.push_back(run);
    }
  }
  for (const Run& other : others)
    look_at(other);
}

void JobQueue::look_at(const Run& other) {
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
      now = own->second->status();  // was watched as another's, and has been taken up here since
    } else {
      if (!is_aside(*other) || taken_.has(**job)) return;
      lose(other);  // another drives its scanner by now
    }
  }
  const std::scoped_lock inner(other->mutex_);
  other->status_ = std::move(now);
}

void JobQueue::tell_ends() {
  if (!ended_) return;
  const auto ends = catalogue_.claim_untold({taken_.holder, kTelling});
  if (!ends) return;
  for (const JobRecord& job : *ends)
    ended_(JobStatus{job, std::nullopt, {}});
}

bool JobQueue::may_tell(const JobId& id) {
  const auto renewed = catalogue_.renew_untold(id, {taken_.holder, kTelling});
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

}  // namespace vitrine
