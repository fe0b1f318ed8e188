// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/statvfs.h>

#include "server/http/handlers.h"
#include "server/http/job_json.h"
#include "server/http/problem.h"
#include "server/http/services.h"

namespace vitrine {
namespace {

Response plain_text(std::string body) {
  Response response;
  response.type = "text/plain; charset=utf-8";
  response.body = std::move(body);
  return response;
}

void append_exports(std::string& text, ExportCache& exports) {
  append_metric(text, "vitrine_export_cache_hits_total", "", "counter",
                "Exports and posters that were ready.", exports.hits.load());
  append_metric(text, "vitrine_exports_made_total", "", "counter",
                "Exports and posters that were computed.", exports.made.load());
  append_metric(text, "vitrine_export_cache_bytes", "", "gauge", "Held ready.", exports.bytes());
}

void append_models(std::string& text, PublishedModels& models) {
  append_metric(text, "vitrine_model_cache_hits_total", "", "counter",
                "Chunks and models found in memory.", models.hits.load());
  append_metric(text, "vitrine_model_cache_misses_total", "", "counter",
                "Models that had to be opened.", models.misses.load());
  append_metric(text, "vitrine_model_cache_bytes", "", "gauge",
                "Manifests, their texts and the index of their chunks.", models.bytes());
}

// Without a catalogue there are no numbers: /readyz says why.
void append_jobs(std::string& text, JobQueue& jobs) {
  const auto counts = jobs.count();
  for (std::size_t i = 0; counts && i < counts->size(); ++i) {
    append_metric(text, "vitrine_jobs", fmt::format("{{state=\"{}\"}}", kJobStates[i]), "gauge",
                  i == 0 ? "Jobs by state, as the catalogue has them." : "", (*counts)[i]);
  }
}

void append_disk(std::string& text, const std::filesystem::path& data) {
  struct statvfs disk {};
  if (::statvfs(data.c_str(), &disk) != 0) return;
  append_metric(text, "vitrine_data_free_bytes", "", "gauge",
                "Free for this process on the disk of the data folder.",
                std::uint64_t{disk.f_bavail} * disk.f_frsize);
}

}  // namespace

// Alive: this process answers. It stays so while it drains.
Response show_livez(const Request&, Services&) {
  return plain_text("alive\n");
}

// Ready: visitors should be sent here. Not while starting or draining, nor without a catalogue.
Response show_readyz(const Request& request, Services& services) {
  if (!services.ready.load()) return problem(503, "", request.id);
  if (const auto revision = services.catalogue.revision(); !revision) {
    services.errors.event(Severity::kError, revision.error().message);
    return problem(503, "", request.id);
  }
  return plain_text("ready\n");
}

Response show_metrics(const Request&, Services& services) {
  std::string samples = services.metrics.text();
  append_metric(samples, "vitrine_build_info", "{version=\"" VITRINE_VERSION "\"}", "gauge",
                "The version that runs.", 1);
  append_exports(samples, services.exports);
  append_models(samples, services.models);
  append_jobs(samples, services.scans.jobs());
  append_disk(samples, services.settings.get()->data);
  Response response = plain_text(std::move(samples));
  response.type = "text/plain; version=0.0.4; charset=utf-8";
  return response;
}

}  // namespace vitrine
