// SPDX-License-Identifier: Apache-2.0
// Lists the nouns of the public API, such as models and scans, with their routes, and the routes
// for administrators.
#pragma once

#include <span>
#include <string_view>

#include "server/api/api_route.h"

namespace vitrine::server {

// One noun of the API: its routes and schemas. Each noun is defined in a file of its own;
// routes.cpp lists all of them.
struct ApiNoun {
  std::span<const ApiRoute> routes;
  // A JSON object: the noun's part of `components` in the OpenAPI document, such as its schemas.
  // Names that several nouns use are in common_components.cpp.
  std::string_view components = {};
};

extern const ApiNoun kCommon, kChunks, kModels, kStreams, kExports, kPosters, kIiif, kOembed,
    kOpenapi, kModelOrders, kVisits, kScanners, kCalibrations, kScans, kJobs, kUploads, kTokens,
    kPages;

std::span<const ApiNoun* const> public_nouns();
std::span<const ApiRoute> public_routes();
std::span<const ApiRoute> admin_routes();

}  // namespace vitrine::server
