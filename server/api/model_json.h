// SPDX-License-Identifier: Apache-2.0
// Formats models and manifests as JSON.
#pragma once

#include <optional>
#include <string>

#include "server/api/detail_request.h"
#include "server/catalogue/catalogue.h"
#include "server/store/published_model.h"

namespace vitrine::server {

// Formats a model. If `counts_visits` is true and the model is published, its links name the
// address to which viewers report visits.
std::string model_json(const ModelRecord& record, bool counts_visits);
// Returns the entity tag of the text of model_json(). The tag changes with every change of the
// model or of its file.
std::string model_tag(const ModelRecord& record, bool counts_visits);
// Formats one page of the list of models. If `whole` is false, shows only the parts of each model
// that clients without a token may see.
std::string model_page_json(const ModelPage& page, bool whole, bool counts_visits);

// Formats the manifest. If there is a detail request, adds its expected result as `expect`.
std::string manifest_json(const PublishedModel& model, const std::optional<DetailRequest>& detail);

}  // namespace vitrine::server
