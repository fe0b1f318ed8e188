// SPDX-License-Identifier: Apache-2.0
// Reads a detail request from query parameters: triangles, error, bytes, level, or kbps with
// seconds. Exports and manifests accept these parameters.
#pragma once

#include <optional>
#include <string>

#include "codec/core/expected.h"
#include "codec/plan/planner.h"
#include "server/messages/http_header.h"
#include "server/messages/problem.h"
#include "server/messages/query.h"

namespace vitrine::server {

// A client that sends `Save-Data: on` without a detail request gets the finest mesh that fits in
// this many bytes.
inline constexpr std::uint64_t kSavedDataBytes = 1'000'000;

struct DetailRequest {
  Want want;
  bool stated = true;  // false if the request has no detail parameters, so `want` is the default
  double kbps = 0;     // the client's bandwidth in kilobits per second; 0: unknown
};

// Reads the detail request from a query. Without detail parameters, requests the whole model, or
// at most kSavedDataBytes bytes of it if the header has `Save-Data: on`.
tl::expected<DetailRequest, ParameterFault> read_detail_request(const Query& query,
                                                                const RequestHeader& header,
                                                                const Manifest& manifest);

bool saves_data(const RequestHeader& header);

// Returns a key under which the result of `want` can be cached. Equal requests have equal keys,
// however they are written. Requests for more triangles than the whole model has share one key.
// The same holds for bytes.
std::string key_of(const Want& want, const Manifest& manifest);

// The result of a detail request, estimated from the manifest without decoding.
struct DetailForecast {
  std::uint32_t level = 0;  // the finest complete level
  // Number of triangles, at least that of `level`. If only a part of the last chunk is used, the
  // number may be off by the triangles that one split adds, at most two.
  std::uint64_t triangles = 0;
  std::uint64_t bytes = 0;  // total size of the header, the base mesh and the chunks used
  double error = 0;         // upper bound of the error of `level`, in model units
};
DetailForecast forecast_of(const Want& want, const Manifest& manifest);

}  // namespace vitrine::server
