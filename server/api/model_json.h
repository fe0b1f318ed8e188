// SPDX-License-Identifier: Apache-2.0
// Formats models and manifests as JSON.
#pragma once

#include <optional>
#include <string>

#include "codec/core/bounds.h"
#include "server/api/detail_request.h"
#include "server/catalogue/catalogue.h"
#include "server/records/described_model.h"
#include "server/store/published_model.h"

namespace vitrine::server {

// How a model is shown to a client.
struct ModelView {
  // Whether the client has sent a token. Only clients with a token see the repairs, because repairs
  // may contain names of files and other details of the original.
  bool has_token = false;
  // Whether the links of published models include the URL to which viewers report visits.
  bool counts_visits = false;
  std::string origin = {};  // start of the URLs in citations; see origin_of()
  // The setting `public-url`. model_tag() uses it instead of `origin`, which depends on the
  // request's host: a client may read a model at one host and change it at another.
  std::string public_url = {};
};

// Formats the record of a model.
std::string model_json(const ModelRecord& record, const ModelView& view);
// Like the function above, with the additional members `citation` and `dimensions`: width (x),
// height (y, upwards) and depth (z) of the presented mesh in the model's unit, or null if the unit
// is unknown. `manifest` describes a file that contains the model's geometry.
std::string model_json(const ModelRecord& record, const Manifest& manifest, const ModelView& view);
// Returns the dimensions of the presented mesh in the model's unit, or nullopt if the unit is
// unknown.
std::optional<Dimensions> dimensions_of(const ModelRecord& record, const Manifest& manifest);
// Returns the entity tag of the text of model_json(). The tag changes with every change of the
// model or of its file.
std::string model_tag(const ModelRecord& record, const ModelView& view);
// Formats one page of the list of models. If `view.has_token` is false, shows only the parts of
// each model that clients without a token may see.
std::string model_page_json(const ModelPage& page, const ModelView& view);

std::string facets_json(const Facets& facets);

// Returns the bounding box of all levels in model units, clamped to the lattice (the grid of the
// coded positions).
Bounds bounding_box(const Manifest& manifest);

// Returns the bounding box of the model in the model's unit, after it was turned and scaled as the
// record's presentation states.
Bounds presented_box(const ModelRecord& record, const Manifest& manifest);

// Formats the manifest. If there is a detail request, adds its expected result as `expect`.
std::string manifest_json(const PublishedModel& model, const std::optional<DetailRequest>& detail);

}  // namespace vitrine::server
