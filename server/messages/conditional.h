// SPDX-License-Identifier: Apache-2.0
// Handles conditional and range requests ([RFC9110] sections 13 and 14). Supports one byte range
// and strong validators.
#pragma once

#include <optional>
#include <string_view>

#include "server/messages/http_header.h"
#include "server/messages/response.h"

namespace vitrine::server {

// Whether an If-Match list is "*", contains the strong tag `etag`, or contains the tag of the
// compressed body (in_accepted_coding()). Weak tags never match ([RFC9110] section 13.1.1).
bool matches_any(std::string_view list, std::string_view etag);

// Whether an If-None-Match list is "*" or contains `etag`. In contrast to matches_any(), a weak tag
// in the list also matches ([RFC9110] section 13.1.2).
bool matches_any_weakly(std::string_view list, std::string_view etag);

struct RangeChoice {
  enum class Outcome { kWhole, kPart, kUnsatisfiable } outcome = Outcome::kWhole;
  std::uint64_t offset = 0, length = 0;  // the selected bytes, if `outcome` is kPart
};
// Selects the part of a body of `size` bytes that a Range field requests. Returns kUnsatisfiable if
// that part is empty. Returns kWhole if the field has several ranges, a unit other than bytes, or a
// malformed value, as [RFC9110] section 14.2 allows.
RangeChoice choose_range(std::string_view range, std::uint64_t size);

// Applies If-None-Match and Range of the request to `response`, the complete response to a GET or
// HEAD. Returns a response with status 304, 206 or 416 if these fields require it, otherwise
// `response`. A response without an ETag, or with a status other than 200, stays unchanged.
Response apply_conditions(const RequestHeader& request, Response response,
                          std::string_view request_id);

}  // namespace vitrine::server
