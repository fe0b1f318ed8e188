// SPDX-License-Identifier: Apache-2.0
// Formats points in time for JSON, XML and HTTP header fields, and parses them.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vitrine::server {

// Formats milliseconds since 1970, UTC, in the form of [ISO8601].
std::string timestamp(std::int64_t milliseconds);

// Formats seconds since 1970, UTC, for HTTP header fields ([RFC9110] section 5.6.7).
std::string http_date(std::int64_t seconds);

// Formats seconds since 1970, UTC, such as 2026-11-28T09:30:00Z.
std::string utc_time(std::int64_t seconds);

// Parses a date of the form 2026-11-28, from the year 1 to 9999. Returns nullopt if it is invalid.
std::optional<std::chrono::sys_days> parse_date(std::string_view text);

// Parses a time of the form 2026-11-28T09:30:00Z. Returns the seconds since 1970, UTC, negative for
// earlier times, or nullopt if the time is invalid.
std::optional<std::int64_t> parse_utc_time(std::string_view text);

}  // namespace vitrine::server
