// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "server/jobs/job_queue.h"

namespace vitrine::server {

JobStatus JobRun::status() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

StopRequest JobRun::stop_request() const {
  const std::scoped_lock lock(mutex_);
  return stop_request_;
}

std::uint64_t JobRun::stops_known() const {
  const std::scoped_lock lock(mutex_);
  return stops_known_;
}

void JobRun::when_asked(std::function<void()> react) {
  const std::scoped_lock lock(mutex_);
  react_ = std::move(react);
  if (react_ && stop_request_ != StopRequest::kNone) react_();
}

void JobRun::request_stop(StopRequest request, std::string_view reason) {
  const std::scoped_lock lock(mutex_);
  if (waits_ && request == StopRequest::kStop) request = StopRequest::kPause;
  // A job that is to be cancelled cannot be paused or stopped, and a paused job stays paused when
  // the daemon ends. A job that another daemon has claimed is abandoned in any case.
  if (stop_request_ == StopRequest::kLost) return;
  const bool holds = stop_request_ == StopRequest::kCancel ||
                     (stop_request_ == StopRequest::kPause && request == StopRequest::kStop);
  if (holds && request != StopRequest::kLost) return;
  stop_request_ = request;
  if (!reason.empty()) status_.note = pause_reason_ = reason;
  changed_.notify_all();
  if (react_ && request != StopRequest::kNone) react_();
}

bool JobRun::await_resume(std::string_view stage, double progress, std::string_view note) {
  JobStatus paused = status();
  paused.record.state = JobState::kPaused;
  paused.record.stage = stage;
  paused.record.progress = std::max(paused.record.progress, progress);
  paused.eta.reset();
  paused.note = note;
  entered_stage_(paused.record);  // called before an operator can resume the job
  std::unique_lock lock(mutex_);
  if (stop_request_ != StopRequest::kNone) return false;
  status_ = std::move(paused);
  waits_ = true;
  changed_.wait(lock, [this] { return !waits_ || stop_request_ != StopRequest::kNone; });
  waits_ = false;
  status_.record.state = JobState::kRunning;
  return stop_request_ == StopRequest::kNone;
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

void JobRun::repaired(std::string repairs) {
  const std::scoped_lock lock(mutex_);
  status_.record.repairs = std::move(repairs);
}

void JobRun::restart() {
  const std::scoped_lock lock(mutex_);
  status_.record.progress = 0;
}

}  // namespace vitrine::server
