// SPDX-License-Identifier: Apache-2.0
// Formats points in time for JSON and for HTTP header fields.
#pragma once

#include <cstdint>
#include <string>

namespace vitrine::server {

// Formats milliseconds since 1970, UTC, as ISO 8601.
std::string timestamp(std::int64_t milliseconds);

// Formats seconds since 1970, UTC, for HTTP header fields (RFC 9110, 5.6.7).
std::string http_date(std::int64_t seconds);

}  // namespace vitrine::server
