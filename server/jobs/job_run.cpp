// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "server/jobs/job_queue.h"

namespace vitrine {

JobStatus JobRun::status() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

JobWish JobRun::wish() const {
  const std::scoped_lock lock(mutex_);
  return wish_;
}

std::uint64_t JobRun::stops_known() const {
  const std::scoped_lock lock(mutex_);
  return stops_known_;
}

void JobRun::when_asked(std::function<void()> react) {
  const std::scoped_lock lock(mutex_);
  react_ = std::move(react);
  if (react_ && wish_ != JobWish::kNone) react_();
}

void JobRun::ask(JobWish wish, std::string_view reason) {
  const std::scoped_lock lock(mutex_);
  if (waits_ && wish == JobWish::kStop) wish = JobWish::kPause;
  // Nothing takes a cancellation back, and what is paused stays so when the daemon ends; but who
  // has lost the job has no say in it.
  if (wish_ == JobWish::kLost) return;
  const bool holds =
      wish_ == JobWish::kCancel || (wish_ == JobWish::kPause && wish == JobWish::kStop);
  if (holds && wish != JobWish::kLost) return;
  wish_ = wish;
  if (!reason.empty()) status_.note = pause_reason_ = reason;
  changed_.notify_all();
  if (react_ && wish != JobWish::kNone) react_();
}

bool JobRun::await_resume(std::string_view stage, double progress, std::string_view note) {
  JobStatus paused = status();
  paused.record.state = JobState::kPaused;
  paused.record.stage = stage;
  paused.record.progress = std::max(paused.record.progress, progress);
  paused.eta.reset();
  paused.note = note;
  entered_stage_(paused.record);  // before anybody can resume it
  std::unique_lock lock(mutex_);
  if (wish_ != JobWish::kNone) return false;
  status_ = std::move(paused);
  waits_ = true;
  changed_.wait(lock, [this] { return !waits_ || wish_ != JobWish::kNone; });
  waits_ = false;
  status_.record.state = JobState::kRunning;
  return wish_ == JobWish::kNone;
}

bool JobRun::go_on() {
  const std::scoped_lock lock(mutex_);
  if (!waits_) return false;
  waits_ = false;
  status_.record.state = JobState::kRunning;
  changed_.notify_all();
  return true;
}

bool JobRun::is_at_work() const {
  const std::scoped_lock lock(mutex_);
  return waits_ || status_.record.state == JobState::kRunning;
}

void JobRun::report(std::string_view stage, double progress, std::optional<double> eta,
                    std::string_view note) {
  std::optional<JobRecord> entered;
  {
    const std::scoped_lock lock(mutex_);
    const bool is_new = status_.record.stage != stage;
    status_.record.stage = stage;
    status_.record.progress = std::max(status_.record.progress, progress);
    status_.eta = eta;
    if (pause_reason_.empty()) status_.note = note;
    if (is_new) entered = status_.record;
  }
  if (entered) entered_stage_(*entered);
}

void JobRun::made(const ModelId& model) {
  const std::scoped_lock lock(mutex_);
  status_.record.model = model;
}

void JobRun::begin_anew() {
  const std::scoped_lock lock(mutex_);
  status_.record.progress = 0;
}

}  // namespace vitrine
