// SPDX-License-Identifier: Apache-2.0
// How many cases a property test tries.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace vitrine::test {

// `full`, times VITRINE_PROPERTY_SCALE where it is set (0.1 for a build with sanitisers).
inline std::uint64_t cases(std::uint64_t full) {
  const char* text = std::getenv("VITRINE_PROPERTY_SCALE");
  const double scale = text != nullptr ? std::atof(text) : 1.0;
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(static_cast<double>(full) * scale));
}

}  // namespace vitrine::test
