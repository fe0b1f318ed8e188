// SPDX-License-Identifier: Apache-2.0
// Lists the resources ("nouns") of the public API, such as models and scans, with their routes.
// Also lists the routes for administrators.
#pragma once

#include <span>
#include <string_view>

#include "server/api/api_route.h"

namespace vitrine::server {

// A tag of the OpenAPI document, under which it groups routes. Each documented route has the tag
// that equals the first word of its path after /api/v1.
struct ApiTag {
  std::string_view name;
  std::string_view description;  // one sentence
};

// One resource of the API: its routes and schemas. Each resource is defined in its own file;
// routes.cpp lists all of them.
struct ApiNoun {
  std::span<const ApiRoute> routes;
  // A JSON object: the part of `components` in the OpenAPI document that this resource defines,
  // such as schemas. kCommon has the parts that several resources use.
  std::string_view components = {};
  std::span<const ApiTag> tags = {};
};

extern const ApiNoun kCommon, kChunks, kModels, kStreams, kExports, kTileset, kPosters, kIiif,
    kRecords, kOai, kOembed, kOpenapi, kModelOrders, kAnnotations, kVisits, kScanners,
    kCalibrations, kScans, kJobs, kUploads, kTokens, kPages;

std::span<const ApiNoun* const> public_nouns();
std::span<const ApiRoute> public_routes();
std::span<const ApiRoute> admin_routes();

}  // namespace vitrine::server
