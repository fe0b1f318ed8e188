// SPDX-License-Identifier: Apache-2.0
// Decides what a caller may see of models, scans and jobs. Every handler that shows models, scans
// or jobs calls these functions.
//
// A caller with a token sees everything. A visitor, who has no token, sees the public part of
// published models: no draft, no level finer than the public limit, no replaced file. A visitor
// sees a scan's points, profile, record and job as long as these reveal nothing that the scan's
// model hides. A request for a chunk by its hash alone finds only chunks of public parts
// (PublishedModels::find_chunk).
#pragma once

#include "server/jobs/scan_service.h"
#include "server/messages/router.h"
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

// Returns the file that find_visible() would have to open. Returns nullopt if that file is open
// already or does not exist. May read the catalogue.
std::optional<Opening> opening_of(const ModelId& id, bool has_token, PublishedModels& models);

// Whether visitors see the scan. A scan without a model is visible if it was ordered as public and
// not cancelled. A scan with a model is visible as long as visitors see all geometry that was built
// from the scan: the model is published, no level is hidden, and the file was not replaced. Returns
// false if the catalogue or the store cannot be read.
bool is_visible(const ScanInfo& scan, PublishedModels& models);

// Whether visitors see the job: only a job that measures a visible scan is visible. Fails with kIo
// if the catalogue or the store cannot be read.
Expected<bool> check_visibility(const JobRecord& job, ScanService& scans, PublishedModels& models);
// Like check_visibility(), but opens no file. If this process has not opened the model's file
// before, it cannot compare the geometry. Then returns true only if the job has made the model and
// no level of the model is hidden, so that a visitor sees the job's end.
Expected<bool> check_visibility_unopened(const JobRecord& job, ScanService& scans,
                                         PublishedModels& models);
// Like check_visibility(), but returns false if that function fails.
bool is_visible(const JobRecord& job, ScanService& scans, PublishedModels& models);

}  // namespace vitrine::server
