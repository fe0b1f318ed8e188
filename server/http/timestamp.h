// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace vitrine {

// Milliseconds since 1970, UTC, as ISO 8601 has them.
std::string timestamp(std::int64_t milliseconds);

}  // namespace vitrine
