// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "server/http/elsewhere.h"
#include "server/http/event_source.h"
#include "server/http/handlers.h"
#include "server/http/job_json.h"
#include "server/http/published.h"

namespace vitrine {
namespace {

// A job as events, from now to its end.
class JobEvents final : public EventSource {
 public:
  JobEvents(JobStatus first, std::shared_ptr<const JobRun> run, bool with_reasons)
      : newest_(std::move(first)), run_(std::move(run)), with_reasons_(with_reasons) {}

  std::optional<Event> next() override {
    if (run_) newest_ = with_reasons_ ? run_->status() : without_reasons(run_->status());
    if (told_ == newest_) return std::nullopt;
    told_ = newest_;
    return Event{"job",
                 job_json(newest_).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
  }
  bool ended() const override { return told_ && has_ended(told_->record.state); }

 private:
  JobStatus newest_;
  std::optional<JobStatus> told_;
  const std::shared_ptr<const JobRun> run_;
  const bool with_reasons_;
};

bool is_public(const JobRecord& job, Services& services) {
  if (!job.scan) return false;
  const auto scan = services.scans.find(*job.scan);
  return scan && *scan && is_public((*scan)->entry, services);
}

// Calls `answer(job)` with the request's job, or answers 401, 404 or 500.
template <class Answer>
Response with_job(const Request& request, Services& services, Answer&& answer) {
  const auto job = services.scans.jobs().find(request.parameters.id);
  if (!job) return internal_error(job.error(), request, services);
  if (*job && request.caller) return for_caller(answer(**job));
  if (*job && is_public((*job)->record, services)) return answer(without_reasons(**job));
  if (!request.caller) return token_needed(request);  // which jobs there are is nobody's business
  return problem(404, "there is no such job", request.id);
}

// With the request's job, where this daemon or nobody in particular does it; else by who does.
template <class Answer>
Response with_own_job(const Request& request, Services& services, Answer&& answer) {
  return with_job(request, services, [&](const JobStatus& job) {
    const auto address = job.record.kind == JobKind::kPublish
                             ? std::nullopt
                             : elsewhere(job.record.scanner, request, services);
    return address ? ask_elsewhere(*address, request, services) : answer(job);
  });
}

}  // namespace

Response list_jobs(const Request& request, Services& services) {
  const auto page = read_page(request);
  if (!page) return page.error();
  const auto jobs = services.scans.jobs().list(*page);
  if (!jobs) return internal_error(jobs.error(), request, services);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const JobStatus& job : *jobs)
    list.push_back(job_json(job));
  const bool may_go_on = jobs->size() == page->limit;
  nlohmann::ordered_json json = {{"jobs", std::move(list)}, {"next", nullptr}};
  if (may_go_on) json["next"] = jobs->back().record.id.to_string();
  return json_answer(json);
}

Response show_job(const Request& request, Services& services) {
  return with_job(request, services,
                  [](const JobStatus& job) { return json_answer(job_json(job)); });
}

Response cancel_job(const Request& request, Services& services) {
  return with_own_job(request, services, [&](const JobStatus& job) {
    const auto cancelled = services.scans.jobs().cancel(job.record.id);
    if (!cancelled) return refused(cancelled.error(), request, services);
    return json_answer(job_json(*cancelled), 202);  // it ends at its next step
  });
}

Response resume_job(const Request& request, Services& services) {
  return with_own_job(request, services, [&](const JobStatus& job) {
    const auto resumed = services.scans.resume(job.record);
    if (!resumed) return refused(resumed.error(), request, services);
    return json_answer(job_json(*resumed), 202);
  });
}

Response show_job_events(const Request& request, Services& services) {
  // First: a job without a run is found at its end then, and nobody waits for one that has passed.
  const auto run = services.scans.jobs().watch(request.parameters.id);
  if (!run) return internal_error(run.error(), request, services);
  return with_job(request, services, [&](const JobStatus& job) {
    Response response;
    response.type = "text/event-stream";
    response.events = std::make_shared<JobEvents>(job, *run, request.caller.has_value());
    return response;
  });
}

}  // namespace vitrine
