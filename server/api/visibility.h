// SPDX-License-Identifier: Apache-2.0
// Decides what a caller may see of models, scans and jobs. Every handler that shows one of them
// asks these functions.
//
// A caller with a token sees everything. A visitor, who has no token, sees the public part of
// published models: no draft, no level above the cap, no earlier file. A visitor sees a scan's
// points, profile, record and job as long as these reveal nothing that the scan's model hides. A
// request for a chunk by its hash alone finds only chunks of public parts
// (PublishedModels::find_chunk).
#pragma once

#include "server/jobs/scan_service.h"
#include "server/store/published_model.h"

namespace vitrine::server {

// The model that was searched for, or null if there is no such model.
using FoundModel = Expected<std::shared_ptr<const PublishedModel>>;

struct VisibleModel {
  FoundModel model;
  bool is_private = false;  // true if caches must not keep responses about the model
};

// Finds a model as the caller may see it. Reads the catalogue and the store.
VisibleModel find_visible(const ModelId& id, bool has_token, PublishedModels& models);

// Returns the model that find_visible() would find, if it is cached and known to be current.
// Otherwise returns null. Does not block.
std::shared_ptr<const PublishedModel> cached_visible(const ModelId& id, bool has_token,
                                                     PublishedModels& models);

// Whether visitors see the scan. If the scan has no model yet, visitors see it if it was ordered as
// public and not cancelled. If it has a model, visitors see the scan as long as they also see all
// geometry that was built from it: the model is published, no level is hidden, and the file was not
// replaced. If the catalogue or the store cannot be read, returns false.
bool is_visible(const ScanInfo& scan, PublishedModels& models);

// Whether visitors see the job. They see a job only if it measures a scan that they see.
bool is_visible(const JobRecord& job, ScanService& scans, PublishedModels& models);

}  // namespace vitrine::server
