// SPDX-License-Identifier: Apache-2.0
// Data that is spelt out in a URI (RFC 2397).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace vitrine {

inline bool is_data_uri(std::string_view uri) {
  return uri.starts_with("data:");
}

// The bytes of a data: URI in base64 (RFC 4648), fewer than it has characters; nothing where it is
// another.
std::optional<std::vector<std::uint8_t>> data_in_uri(std::string_view uri);

}  // namespace vitrine
