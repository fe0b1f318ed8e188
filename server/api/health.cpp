// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/statvfs.h>

#include "server/api/handlers.h"
#include "server/api/job_json.h"
#include "server/api/routes.h"
#include "server/api/services.h"
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

// Appends the number of jobs in each state. If the catalogue cannot be read, appends nothing;
// /readyz then fails and logs the reason.
void append_jobs(std::string& text, JobQueue& jobs) {
  const auto counts = jobs.count();
  for (std::size_t i = 0; counts && i < counts->size(); ++i) {
    append_metric(text, "vitrine_jobs", fmt::format("{{state=\"{}\"}}", kJobStates[i]), "gauge",
                  i == 0 ? "Jobs in the catalogue by state." : "", (*counts)[i]);
  }
}

void append_disk(std::string& text, const std::filesystem::path& data) {
  struct statvfs disk {};
  if (::statvfs(data.c_str(), &disk) != 0) return;
  append_metric(text, "vitrine_data_free_bytes", "", "gauge",
                "Free bytes for this process on the disk of the data folder.",
                std::uint64_t{disk.f_bavail} * disk.f_frsize);
}

}  // namespace

// Answers the liveness probe. Succeeds as long as this process responds, even while it drains.
static Response show_livez(const Request&, Services&) {
  return plain_text("alive\n");
}

// Answers the readiness probe, which tells whether to route requests to this daemon. Fails while
// the daemon starts or drains, and if it cannot read the catalogue.
static Response show_readyz(const Request& request, Services& services) {
  if (!services.ready.load()) return problem(503, "", request.id);
  if (const auto revision = services.catalogue.revision(); !revision) {
    services.errors.event(Severity::kError, revision.error().message);
    return problem(503, "", request.id);
  }
  return plain_text("ready\n");
}

static Response show_metrics(const Request&, Services& services) {
  std::string samples = services.metrics.text();
  append_metric(samples, "vitrine_build_info", "{version=\"" VITRINE_VERSION "\"}", "gauge",
                "The running version, in the label.", 1);
  append_exports(samples, services.exports);
  append_models(samples, services.models);
  append_jobs(samples, services.scans.jobs());
  append_disk(samples, services.settings.get()->data);
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
