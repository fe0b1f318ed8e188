// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace vitrine {

// Milliseconds since 1970, UTC, as ISO 8601 has them.
std::string timestamp(std::int64_t milliseconds);

// Seconds since 1970, UTC, as the fields of HTTP have them (RFC 9110, 5.6.7).
std::string http_date(std::int64_t seconds);

}  // namespace vitrine
