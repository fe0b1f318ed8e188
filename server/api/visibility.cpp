// SPDX-License-Identifier: Apache-2.0
#include "server/api/visibility.h"

#include "server/jobs/job_claim.h"

namespace vitrine::server {
namespace {

bool is_whole(const FoundModel& published) {
  return published && *published && !(*published)->record().public_part;
}

// Whether visitors see a scan that has no model yet. A job first adds its model to the catalogue
// and later records the model in the scan. If the job ends in between, the scan cannot follow later
// changes of the model, so the scan is hidden. A scan of a cancelled job is hidden, too.
bool is_visible_without_model(const ScanInfo& scan) {
  const JobRecord& job = scan.job.record;
  return scan.entry.is_public && job.state != JobState::kCancelled &&
         (!job.model || !has_ended(job.state));
}

// Whether visitors see the geometry that was built from the scan. The scan must have a model. Fails
// with kIo if the catalogue or the store cannot be read.
Expected<bool> shows_geometry(const ScanInfo& scan, PublishedModels& models) {
  const FoundModel shown = find_visible(*scan.entry.model, false, models).model;
  if (!shown && shown.error().code == ErrorCode::kIo) return tl::unexpected(shown.error());
  return shown && *shown && geometry_hash((*shown)->manifest()) == scan.entry.built;
}

// Like shows_geometry(), but opens no file. If the file was not opened before, its geometry is
// unknown. Then returns whether visitors see all of the model that the scan's job has made.
Expected<bool> shows_geometry_unopened(const ScanInfo& scan, PublishedModels& models) {
  const ModelId& model = *scan.entry.model;
  const auto shown = models.file_of(model, false);
  if (!shown) return tl::unexpected(shown.error());
  if (!*shown) return false;
  if (const auto geometry = models.known_geometry(**shown)) return geometry == scan.entry.built;
  if (model != model_id_of(scan.job.record)) return false;
  return models.file_of(model, true).map([&](const auto& whole) { return whole == *shown; });
}

using ShowsGeometry = Expected<bool>(const ScanInfo& scan, PublishedModels& models);

// Returns is_visible(scan, models). Fails if `shows` fails.
Expected<bool> check_visibility(const ScanInfo& scan, PublishedModels& models,
                                ShowsGeometry shows) {
  if (!scan.entry.model) return is_visible_without_model(scan);
  if (!scan.entry.built) return false;
  return shows(scan, models);
}

Expected<bool> check_visibility(const JobRecord& job, ScanService& scans, PublishedModels& models,
                                ShowsGeometry shows) {
  if (!job.scan) return false;
  const auto scan = scans.find(*job.scan);
  if (!scan) return tl::unexpected(scan.error());
  if (!*scan || (*scan)->entry.job != job.id) return false;
  return check_visibility(**scan, models, shows);
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

std::optional<Opening> opening_of(const ModelId& id, bool has_token, PublishedModels& models) {
  const auto file = models.unopened(id, has_token);
  if (!file) return std::nullopt;
  return Opening{.name = to_hex(*file), .open = [id, has_token, &models] {
                   return find_visible(id, has_token, models).model.has_value();
                 }};
}

bool is_visible(const ScanInfo& scan, PublishedModels& models) {
  return check_visibility(scan, models, shows_geometry).value_or(false);
}

Expected<bool> check_visibility(const JobRecord& job, ScanService& scans, PublishedModels& models) {
  return check_visibility(job, scans, models, shows_geometry);
}

Expected<bool> check_visibility_unopened(const JobRecord& job, ScanService& scans,
                                         PublishedModels& models) {
  return check_visibility(job, scans, models, shows_geometry_unopened);
}

bool is_visible(const JobRecord& job, ScanService& scans, PublishedModels& models) {
  return check_visibility(job, scans, models).value_or(false);
}

}  // namespace vitrine::server
