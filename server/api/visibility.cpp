// SPDX-License-Identifier: Apache-2.0
#include "server/api/visibility.h"

namespace vitrine::server {
namespace {

bool is_whole(const FoundModel& published) {
  return published && *published && !(*published)->record().public_part;
}

// A job adds its model to the catalogue first and records the model in the scan later. If the job
// ends between these steps, the scan cannot follow later changes of the model, so the scan is
// hidden. Cancelling the job hides the scan, too.
bool is_visible_without_model(const ScanInfo& scan) {
  const JobRecord& job = scan.job.record;
  return scan.entry.is_public && job.state != JobState::kCancelled &&
         (!job.model || !has_ended(job.state));
}

}  // namespace

VisibleModel find_visible(const ModelId& id, bool has_token, PublishedModels& models) {
  FoundModel published = models.find(id);
  if (!has_token || !published || is_whole(published)) return {std::move(published)};
  return {models.find_whole(id), true};
}

std::shared_ptr<const PublishedModel> cached_visible(const ModelId& id, bool has_token,
                                                     PublishedModels& models) {
  auto published = models.cached(id);
  const bool is_all = published && !published->record().public_part;
  return has_token && !is_all ? models.cached_whole(id) : published;
}

bool is_visible(const ScanInfo& scan, PublishedModels& models) {
  if (!scan.entry.model) return is_visible_without_model(scan);
  if (!scan.entry.built) return false;
  const FoundModel shown = find_visible(*scan.entry.model, false, models).model;
  return shown && *shown && geometry_hash((*shown)->manifest()) == *scan.entry.built;
}

bool is_visible(const JobRecord& job, ScanService& scans, PublishedModels& models) {
  if (!job.scan) return false;
  const auto scan = scans.find(*job.scan);
  return scan && *scan && (*scan)->entry.job == job.id && is_visible(**scan, models);
}

}  // namespace vitrine::server
