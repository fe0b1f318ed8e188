// SPDX-License-Identifier: Apache-2.0
#include "server/api/visibility.h"

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

// Returns the geometry_hash() of the model as visitors see it, or nullopt if they do not see it.
// Fails with kIo if the catalogue or the store cannot be read.
using Geometry = Expected<std::optional<Sha256>>;

Geometry shown_geometry(const ModelId& id, PublishedModels& models) {
  const FoundModel shown = find_visible(id, false, models).model;
  if (!shown && shown.error().code == ErrorCode::kIo) return tl::unexpected(shown.error());
  if (!shown || !*shown) return std::nullopt;
  return geometry_hash((*shown)->manifest());
}

// Like shown_geometry(), but opens no file. Also returns nullopt if the file was not opened before.
Geometry known_geometry(const ModelId& id, PublishedModels& models) {
  return models.file_of(id, false).map([&](const std::optional<Sha256>& file) {
    return file ? models.known_geometry(*file) : std::nullopt;
  });
}

using FindGeometry = Geometry(const ModelId& id, PublishedModels& models);

// Returns is_visible(scan, models). Fails if `geometry_of` fails.
Expected<bool> check_visibility(const ScanInfo& scan, PublishedModels& models,
                                FindGeometry geometry_of) {
  if (!scan.entry.model) return is_visible_without_model(scan);
  if (!scan.entry.built) return false;
  const auto geometry = geometry_of(*scan.entry.model, models);
  if (!geometry) return tl::unexpected(geometry.error());
  return *geometry == scan.entry.built;
}

Expected<bool> check_visibility(const JobRecord& job, ScanService& scans, PublishedModels& models,
                                FindGeometry geometry_of) {
  if (!job.scan) return false;
  const auto scan = scans.find(*job.scan);
  if (!scan) return tl::unexpected(scan.error());
  if (!*scan || (*scan)->entry.job != job.id) return false;
  return check_visibility(**scan, models, geometry_of);
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
  return check_visibility(scan, models, shown_geometry).value_or(false);
}

Expected<bool> check_visibility(const JobRecord& job, ScanService& scans, PublishedModels& models) {
  return check_visibility(job, scans, models, shown_geometry);
}

Expected<bool> check_visibility_unopened(const JobRecord& job, ScanService& scans,
                                         PublishedModels& models) {
  return check_visibility(job, scans, models, known_geometry);
}

bool is_visible(const JobRecord& job, ScanService& scans, PublishedModels& models) {
  return check_visibility(job, scans, models).value_or(false);
}

}  // namespace vitrine::server
