// SPDX-License-Identifier: Apache-2.0
// Models and manifests as JSON.
#pragma once

#include <string>
#include <string_view>

#include "server/catalogue/catalogue.h"
#include "server/store/published_model.h"

namespace vitrine {

// The strong entity tag of a body.
std::string entity_tag(std::string_view body);

std::string model_json(const ModelRecord& record);
std::string model_page_json(const ModelPage& page, bool whole);  // else as visitors see it
std::string manifest_json(const PublishedModel& model);

}  // namespace vitrine
