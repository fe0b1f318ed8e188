// SPDX-License-Identifier: Apache-2.0
// Conditional and range requests (RFC 9110, sections 13 and 14): one byte range, strong validators.
#pragma once

#include <optional>
#include <string_view>

#include "server/http/http_header.h"
#include "server/http/response.h"

namespace vitrine {

// If-Match: "*", or a list that holds `etag`, which is strong; a weak tag never matches (RFC 9110,
// 13.1.1).
bool matches_any(std::string_view list, std::string_view etag);

// If-None-Match: likewise, but weak tags match, too (RFC 9110, 13.1.2).
bool matches_any_weakly(std::string_view list, std::string_view etag);

struct RangeChoice {
  enum class Kind { kWhole, kPart, kUnsatisfiable } kind = Kind::kWhole;
  std::uint64_t offset = 0, length = 0;  // of kPart
};
// A Range field's value against a body of `size` bytes. What we do not serve (several ranges, other
// units, nonsense) is ignored, as RFC 9110 14.2 allows: the answer is the whole.
RangeChoice choose_range(std::string_view range, std::uint64_t size);

// Turns the complete answer to a GET or HEAD into 304, 206 or 416 where the request asks for it.
// Answers other than 200 and those without an ETag stay as they are.
Response apply_conditions(const RequestHeader& request, Response response,
                          std::string_view request_id);

}  // namespace vitrine
