// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <mutex>
#include <nlohmann/json.hpp>

#include "server/api/forward.h"
#include "server/api/handlers.h"
#include "server/api/job_json.h"
#include "server/api/path_parameters.h"
#include "server/api/published.h"
#include "server/messages/event_source.h"

namespace vitrine::server {
namespace {

// Returns the ID of the event that reports this status. If the job has ended, all its events have
// the same ID.
std::string event_id(const JobStatus& job) {
  const std::string_view state = kJobStates[static_cast<std::size_t>(job.record.state)];
  return has_ended(job.record.state) ? std::string(state)
                                     : fmt::format("{}-{:.3f}", state, job.record.progress);
}

// Whether the client already received the job's last event. Such a client has reconnected only
// because the event stream ended.
bool knows_the_end(const JobStatus& job, const Request& request) {
  return has_ended(job.record.state) && request.header["Last-Event-ID"] == event_id(job);
}

// Sends an event for each change of a job, until the job ends or is hidden from the client.
class JobEvents final : public EventSource {
 public:
  JobEvents(JobStatus first, std::shared_ptr<const JobRun> run, bool is_for_visitor,
            Services& services)
      : newest_(std::move(first)),
        run_(std::move(run)),
        is_for_visitor_(is_for_visitor),
        services_(services) {}

  std::optional<Event> next() override {
    if (run_) newest_ = is_for_visitor_ ? without_reasons(run_->status()) : run_->status();
    if (told_ == newest_) return std::nullopt;
    told_ = newest_;
    return Event{"job",
                 job_json(newest_).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
                 event_id(newest_)};
  }
  bool ended() const override { return told_ && has_ended(told_->record.state); }

  // Reads the catalogue only if a model or the job's state has changed since the last check. If the
  // catalogue cannot be read, the job counts as visible, and the next call checks it again. Opens
  // no file, because that may take long. If the model has a file that was not opened before, ends
  // the connection, unless the job has just made the model; the client's next request opens the
  // file.
  bool may_continue() override {
    if (!is_for_visitor_ || !run_) return true;
    const auto revision = services_.models.revision();
    if (!revision) return true;
    const JobRecord job = run_->job();
    const Checked now{*revision, job.state};
    const std::scoped_lock lock(mutex_);
    if (checked_ == now) return true;
    const auto visible = check_visibility_unopened(job, services_.scans, services_.models);
    if (visible && *visible) checked_ = now;
    return !visible || *visible;
  }

 private:
  struct Checked {
    ModelsRevision revision;
    JobState state;
    bool operator==(const Checked&) const = default;
  };

  JobStatus newest_;
  std::optional<JobStatus> told_;
  const std::shared_ptr<const JobRun> run_;
  const bool is_for_visitor_;
  Services& services_;
  std::mutex mutex_;                // guards the member below
  std::optional<Checked> checked_;  // models' revision and job's state when last found visible
};

// Calls `answer(job)` with the job that the request names. Returns 401 or 404 if there is no job
// that the caller may see, and 500 or 503 if an error occurs.
template <class Answer>
Response with_job(const Request& request, Services& services, Answer&& answer) {
  const auto job = services.scans.jobs().find(id_in<JobId>(request));
  if (!job) return internal_error(job.error(), request, services);
  if (*job && request.caller) return for_caller(answer(**job));
  if (*job && is_visible((*job)->record, services.scans, services.models))
    return answer(without_reasons(**job));
  // Responds with 401 instead of 404, so that the response does not reveal which jobs exist.
  if (!request.caller) return token_needed(request);
  return problem(404, "there is no such job", request.id);
}

// Calls `answer(job)` with the job that the request names. Forwards the request if another daemon
// drives the job's scanner.
template <class Answer>
Response with_own_job(const Request& request, Services& services, Answer&& answer) {
  return with_job(request, services, [&](const JobStatus& job) {
    const auto address = job.record.kind == JobKind::kPublish
                             ? std::nullopt
                             : forward_address(job.record.scanner, request, services);
    return address ? forward(*address, request, services) : answer(job);
  });
}

}  // namespace

static Response list_jobs(const Request& request, Services& services) {
  const auto page = read_page<JobId>(request);
  if (!page) return page.error();
  const auto jobs = services.scans.jobs().list(*page);
  if (!jobs) return internal_error(jobs.error(), request, services);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const JobStatus& job : *jobs)
    list.push_back(job_json(job));
  std::optional<std::string> next;
  if (jobs->size() == page->limit) next = jobs->back().record.id.to_string();
  return list_answer("jobs", std::move(list), next, request);
}

static Response show_job(const Request& request, Services& services) {
  return with_job(request, services,
                  [](const JobStatus& job) { return json_answer(job_json(job)); });
}

static Response cancel_job(const Request& request, Services& services) {
  return with_own_job(request, services, [&](const JobStatus& job) {
    const auto cancelled = services.scans.jobs().cancel(job.record.id);
    if (!cancelled) return refused(cancelled.error(), request, services);
    // Responds with 202 (Accepted), because the job ends only at its next step.
    return json_answer(job_json(*cancelled), 202);
  });
}

static Response resume_job(const Request& request, Services& services) {
  return with_own_job(request, services, [&](const JobStatus& job) {
    const auto resumed = services.scans.resume(job.record);
    if (!resumed) return refused(resumed.error(), request, services);
    return json_answer(job_json(*resumed), 202);
  });
}

Response show_job_events(const Request& request, Services& services) {
  // Starts to watch the job before it reads the job's state. In the opposite order, a change
  // between the two steps would be missed.
  const auto run = services.scans.jobs().watch(id_in<JobId>(request));
  if (!run) return internal_error(run.error(), request, services);
  return with_job(request, services, [&](const JobStatus& job) {
    Response response;
    if (knows_the_end(job, request)) {
      response.status = 204;  // makes an EventSource stop reconnecting (HTML, section 9.2)
      return response;
    }
    response.type = "text/event-stream";
    response.events = std::make_shared<JobEvents>(job, *run, !request.caller, services);
    return response;
  });
}

static constexpr std::string_view kJobsComponents = R"json({
"schemas": {
  "JobStarted": {"type": "object", "required": ["job"], "properties": {"job": {"$ref": "#/components/schemas/Id"}}},
  "Job": {"type": "object", "required": ["id", "kind", "state", "stage", "progress", "eta", "error", "scan", "model", "repairs", "created", "ended"],
    "properties": {
      "id": {"$ref": "#/components/schemas/Id"}, "kind": {"type": "string"},
      "state": {"enum": ["queued", "running", "paused", "done", "failed", "cancelled"]}, "stage": {"type": ["string", "null"]},
      "progress": {"type": "number", "minimum": 0, "maximum": 1}, "eta": {"type": ["number", "null"], "description": "Remaining time in seconds"},
      "error": {"type": ["string", "null"]}, "note": {"type": ["string", "null"]}, "scanner": {"type": "string"},
      "scan": {"$ref": "#/components/schemas/IdOrNull"}, "model": {"$ref": "#/components/schemas/IdOrNull"},
      "repairs": {"type": "array", "items": {"type": "string"}, "description": "What the build of the model changed or left out"},
      "created": {"$ref": "#/components/schemas/Time"}, "ended": {"anyOf": [{"$ref": "#/components/schemas/Time"}, {"type": "null"}]}}},
  "JobPage": {"type": "object", "required": ["jobs", "next"], "properties": {
    "jobs": {"type": "array", "items": {"$ref": "#/components/schemas/Job"}}, "next": {"$ref": "#/components/schemas/Next"}}}
}
})json";

static constexpr ApiRoute kJobRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/jobs",
     .handler = list_jobs,
     .executor = Executor::kWorker,
     .role = Role::kViewer,
     .doc = {.id = "listJobs",
             .summary = "Lists the jobs, newest first.",
             .parameters = "limit cursor",
             .response = "JobPage"}},
    {.method = Method::kGet,
     .path = "/api/v1/jobs/{id}",
     .handler = show_job,
     .executor = Executor::kWorker,
     .doc = {.id = "getJob", .summary = "Returns a job's state and progress.", .response = "Job"}},
    {.method = Method::kDelete,
     .path = "/api/v1/jobs/{id}",
     .handler = cancel_job,
     .executor = Executor::kWorker,
     .role = Role::kOperator,
     .doc = {.id = "cancelJob",
             .summary = "Cancels a job after its current step.",
             .status = 202,
             .response = "Job"}},
    {.method = Method::kPost,
     .path = "/api/v1/jobs/{id}/resume",
     .handler = resume_job,
     .executor = Executor::kWorker,
     .role = Role::kOperator,
     .doc = {.id = "resumeJob",
             .summary = "Resumes a paused or interrupted job.",
             .request = "Nothing",
             .is_request_optional = true,
             .status = 202,
             .response = "Job"}},
    {.method = Method::kGet,
     .path = "/api/v1/jobs/{id}/events",
     .handler = show_job_events,
     .executor = Executor::kWorker,
     .doc = {.id = "followJob",
             .summary = "Sends a server-sent event `job` with the job's state at every change, "
                        "until the job ends. A client that connects again after the last event "
                        "(Last-Event-ID) receives 204.",
             .response = "text/event-stream"}},
};

static constexpr ApiTag kJobsTags[] = {
    {.name = "jobs", .description = "Work in the background, such as a build or a scan."}};

const ApiNoun kJobs = {.routes = kJobRoutes, .components = kJobsComponents, .tags = kJobsTags};

}  // namespace vitrine::server
