// SPDX-License-Identifier: Apache-2.0
#include "server/api/routes.h"

#include <array>

namespace vitrine::server {
namespace {

// All nouns of the API, in the order in which the OpenAPI document lists them. The router matches
// paths in the same order.
constexpr std::array kNouns = {&kCommon,  &kChunks,   &kModels,       &kStreams, &kExports,
                               &kPosters, &kIiif,     &kOembed,       &kOpenapi, &kModelOrders,
                               &kVisits,  &kScanners, &kCalibrations, &kScans,   &kJobs,
                               &kUploads, &kTokens,   &kPages};

}  // namespace

std::span<const ApiNoun* const> public_nouns() {
  return kNouns;
}

std::span<const ApiRoute> public_routes() {
  static const std::vector<ApiRoute> all = [] {
    std::vector<ApiRoute> routes;
    for (const ApiNoun* noun : kNouns)
      routes.insert(routes.end(), noun->routes.begin(), noun->routes.end());
    return routes;
  }();
  return all;
}

}  // namespace vitrine::server
