// SPDX-License-Identifier: Apache-2.0
// Reads a detail request from query parameters: triangles, error, bytes, level, or kbps with
// seconds. Exports and manifests accept these parameters.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

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
  bool is_stated = true;  // false if the request has no detail parameters, so `want` is the default
  double kbps = 0;        // the client's bandwidth in kilobits per second; 0: unknown
};

// Reads the detail request from a query. Without detail parameters, requests the whole model, or at
// most kSavedDataBytes bytes of it if the header has `Save-Data: on`. Fails if the query has a
// parameter that is neither a detail parameter nor in `other`.
tl::expected<DetailRequest, ParameterFault> read_detail_request(
    const Query& query, const RequestHeader& header, const Manifest& manifest,
    std::span<const std::string_view> other = {});

bool saves_data(const RequestHeader& header);

// Returns a key under which the result of `want` can be cached. Equal detail requests have equal
// keys, even if their query texts differ. Requests for more triangles than the model has share one
// key. Requests for more bytes than the model has share another key.
std::string key_of(const Want& want, const Manifest& manifest);

// The result of a detail request, estimated from the manifest without decoding.
struct DetailForecast {
  std::uint32_t level = 0;  // the finest complete level
  // Estimated number of triangles, at least as many as `level` has. The estimate is off by at most
  // two triangles, and only if the last chunk is used in part.
  std::uint64_t triangles = 0;
  std::uint64_t bytes = 0;  // total size of the header, the base mesh and the chunks used
  double error = 0;         // upper bound of the error of `level`, in model units
};
DetailForecast forecast_of(const Want& want, const Manifest& manifest);

}  // namespace vitrine::server
