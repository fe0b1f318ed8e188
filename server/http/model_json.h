// SPDX-License-Identifier: Apache-2.0
// Models and manifests as JSON.
#pragma once

#include <optional>
#include <string>

#include "server/catalogue/catalogue.h"
#include "server/http/wish.h"
#include "server/store/published_model.h"

namespace vitrine {

std::string model_json(const ModelRecord& record);
// The entity tag of that text: another one with each change of the model, of its file too.
std::string model_tag(const ModelRecord& record);
std::string model_page_json(const ModelPage& page, bool whole);  // else as visitors see it

// With `expect`: what comes of the wish, where there is one.
std::string manifest_json(const PublishedModel& model, const std::optional<Wish>& wish);

}  // namespace vitrine
