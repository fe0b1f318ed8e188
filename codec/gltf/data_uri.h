// SPDX-License-Identifier: Apache-2.0
// Decodes data embedded in a URI [RFC2397].
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace vitrine::inline codec {

inline bool is_data_uri(std::string_view uri) {
  return uri.starts_with("data:");
}

// Decodes a base64 data: URI [RFC2397] [RFC4648]. Returns nullopt for any other URI. The number of
// decoded bytes is smaller than the number of characters in `uri`.
std::optional<std::vector<std::uint8_t>> data_in_uri(std::string_view uri);

}  // namespace vitrine::inline codec
