// SPDX-License-Identifier: Apache-2.0
#include "codec/files/companions.h"

#include <charconv>

namespace vitrine::inline codec {

std::string companion_key(std::string_view path) {
  const std::size_t slash = path.find_last_of("/\\");
  std::string key(slash == path.npos ? path : path.substr(slash + 1));
  for (char& c : key)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return key;
}

std::string percent_decoded(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    std::uint8_t byte = 0;
    const char *digits = uri.data() + i + 1, *end = digits + 2;
    if (uri[i] == '%' && i + 2 < uri.size() && std::from_chars(digits, end, byte, 16).ptr == end) {
      out += static_cast<char>(byte);
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

std::optional<std::span<const std::uint8_t>> find_companion(const Companions& companions,
                                                            std::string_view path) {
  const auto it = companions.find(companion_key(path));
  return it == companions.end() ? std::nullopt : std::optional(it->second);
}

}  // namespace vitrine::inline codec
