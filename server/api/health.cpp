// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "server/api/handlers.h"
#include "server/api/job_json.h"
#include "server/api/routes.h"
#include "server/api/services.h"
#include "server/jobs/free_space.h"
#include "server/messages/problem.h"

namespace vitrine::server {
namespace {

Response plain_text(std::string body) {
  Response response;
  response.type = "text/plain; charset=utf-8";
  response.body = std::move(body);
  return response;
}

void append_exports(std::string& text, ExportCache& exports) {
  append_metric(text, "vitrine_export_cache_hits_total", "", "counter",
                "Exports and posters served from the cache.", exports.hits.load());
  append_metric(text, "vitrine_exports_made_total", "", "counter",
                "Exports and posters that were computed.", exports.made.load());
  append_metric(text, "vitrine_export_cache_bytes", "", "gauge",
                "Bytes of cached exports and posters.", exports.bytes());
}

void append_models(std::string& text, PublishedModels& models) {
  append_metric(text, "vitrine_model_cache_hits_total", "", "counter",
                "Chunks and models served from the cache.", models.hits.load());
  append_metric(text, "vitrine_model_cache_misses_total", "", "counter",
                "Models opened because they were not cached.", models.misses.load());
  append_metric(text, "vitrine_model_cache_bytes", "", "gauge",
                "Memory of cached manifests, their JSON and chunk indices in bytes.",
                models.bytes());
}

void append_scrub(std::string& text, PublishedModels& models, const Scrubber& scrubber) {
  append_metric(text, "vitrine_damaged_objects", "", "gauge",
                "Stored files that are known to be damaged or missing.", models.damaged().size());
  append_metric(text, "vitrine_catalogue_faults", "", "gauge",
                "Faults found in the last check of the catalogue.", scrubber.catalogue_faults);
  append_metric(text, "vitrine_scrub_objects_total", "", "counter",
                "Stored files that were checked in the background.", scrubber.objects);
  append_metric(text, "vitrine_scrub_bytes_total", "", "counter",
                "Bytes that were read to check stored files in the background.", scrubber.bytes);
  append_metric(text, "vitrine_scrub_finished_timestamp_seconds", "", "gauge",
                "End of the last whole background check, in seconds since 1970; 0 if none.",
                static_cast<std::uint64_t>(scrubber.finished.load()));
}

// Appends the number of jobs in each state. If the catalogue cannot be read, appends nothing;
// /readyz then fails and logs the reason.
void append_jobs(std::string& text, JobQueue& jobs) {
  const auto counts = jobs.count();
  for (std::size_t i = 0; counts && i < counts->size(); ++i) {
    append_metric(text, "vitrine_jobs", fmt::format("{{state=\"{}\"}}", kJobStates[i]), "gauge",
                  i == 0 ? "Jobs in the catalogue by state." : "", (*counts)[i]);
  }
}

void append_disk(std::string& text, const Settings& settings) {
  const std::uint64_t free = free_space(settings);
  append_metric(text, "vitrine_data_free_bytes", "", "gauge",
                "Free bytes for this process on the disk of the data folder or of the uploads, "
                "whichever has fewer.",
                free);
  append_metric(text, "vitrine_disk_nearly_full", "", "gauge",
                "1 if that is less than the setting disk-reserve.",
                free < settings.disk_reserve_bytes ? 1 : 0);
}

}  // namespace

// Answers the liveness probe. Succeeds as long as this process responds, even while it drains.
static Response show_livez(const Request&, Services&) {
  return plain_text("alive\n");
}

// Answers the readiness probe, which tells whether to route requests to this daemon. Fails while
// the daemon starts or drains, and if it cannot read the catalogue. A nearly full disk is only
// reported: the daemon can still serve every model.
static Response show_readyz(const Request& request, Services& services) {
  if (!services.is_ready.load()) return problem(503, "", request.id);
  if (const auto revision = services.catalogue.revision(); !revision) {
    services.errors.event(Severity::kError, revision.error().message);
    return problem(503, "", request.id);
  }
  const Settings& settings = services.settings.get();
  const std::uint64_t free = free_space(settings);
  if (free >= settings.disk_reserve_bytes) return plain_text("ready\n");
  return plain_text(
      fmt::format("ready, but the disk is nearly full: {} bytes are free; remove models, add disk "
                  "space or lower disk-reserve\n",
                  free));
}

static Response show_metrics(const Request&, Services& services) {
  std::string samples = services.metrics.text();
  append_metric(samples, "vitrine_build_info", "{version=\"" VITRINE_VERSION "\"}", "gauge",
                "The running version, in the label.", 1);
  append_exports(samples, services.exports);
  append_models(samples, services.models);
  append_scrub(samples, services.models, services.scrubber);
  append_jobs(samples, services.scans.jobs());
  append_disk(samples, services.settings.get());
  Response response = plain_text(std::move(samples));
  response.type = "text/plain; version=0.0.4; charset=utf-8";
  return response;
}

static constexpr ApiRoute kHealthRoutes[] = {
    {.method = Method::kGet,
     .path = "/livez",
     .handler = show_livez,
     .executor = Executor::kInline},
    {.method = Method::kGet,
     .path = "/readyz",
     .handler = show_readyz,
     .executor = Executor::kWorker},
    {.method = Method::kGet,
     .path = "/metrics",
     .handler = show_metrics,
     .executor = Executor::kWorker},
};

std::span<const ApiRoute> admin_routes() {
  return kHealthRoutes;
}

}  // namespace vitrine::server
