// SPDX-License-Identifier: Apache-2.0
#include "server/records/oai_set.h"

#include <fmt/format.h>

#include <cctype>
#include <charconv>

namespace vitrine::server {
namespace {

bool stays_in_set_spec(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x80 && std::isalnum(byte) != 0;
}

}  // namespace

std::string set_spec(std::string_view collection) {
  std::string spec;
  for (const char c : collection)
    spec += stays_in_set_spec(c) ? std::string(1, c)
                                 : fmt::format("_{:02X}", static_cast<unsigned char>(c));
  return spec;
}

std::optional<std::string> collection_of(std::string_view spec) {
  std::string collection;
  for (std::size_t i = 0; i < spec.size(); ++i) {
    if (spec[i] != '_') {
      collection += spec[i];
      continue;
    }
    unsigned value = 0;
    const std::string_view digits = spec.substr(i + 1, 2);
    std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    collection += static_cast<char>(value);
    i += 2;
  }
  // Refuses each text that set_spec() does not return, so that a collection has only one setSpec.
  if (collection.empty() || set_spec(collection) != spec) return std::nullopt;
  return collection;
}

}  // namespace vitrine::server
