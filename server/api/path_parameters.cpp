// SPDX-License-Identifier: Apache-2.0
#include "server/api/path_parameters.h"

#include <algorithm>

#include "codec/core/parse_number.h"
#include "server/catalogue/id.h"
#include "server/messages/query.h"

namespace vitrine::server {
namespace {

bool is_lower_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
}

bool is_id(std::string_view text) {
  return parse_ulid(text).has_value();
}

bool is_sha256(std::string_view text) {
  Sha256 ignored;
  return from_hex(text, ignored);
}

bool is_format(std::string_view text) {
  const auto fits = [](char c) { return is_lower_or_digit(c) || c == '.'; };
  return !text.empty() && text.size() <= 8 && std::ranges::all_of(text, fits);
}

bool is_name(std::string_view text) {
  const auto fits = [](char c) { return is_lower_or_digit(c) || c == '-'; };
  return !text.empty() && text.size() <= 32 && std::ranges::all_of(text, fits);
}

bool is_number(std::string_view text) {
  return !text.empty() && text.size() <= 6 && text.front() != '0' &&
         parse_number<std::uint32_t>(text).has_value();
}

bool is_collection(std::string_view text) {
  constexpr std::size_t kMost = 3 * 4096;  // a name of 4096 bytes, each percent-encoded
  const auto name = text.size() <= kMost ? decode_path(text) : std::nullopt;
  return name && !name->empty();
}

constexpr ParameterPattern kPatterns[] = {{"id", is_id},         {"sha256", is_sha256},
                                          {"format", is_format}, {"name", is_name},
                                          {"number", is_number}, {"collection", is_collection}};

}  // namespace

std::span<const ParameterPattern> parameter_patterns() {
  return kPatterns;
}

Sha256 sha256_in(const Request& request) {
  Sha256 hash{};
  from_hex(request.parameters["sha256"], hash);
  return hash;
}

std::string collection_in(const Request& request) {
  return *decode_path(request.parameters["collection"]);
}

std::uint32_t number_in(const Request& request) {
  return *parse_number<std::uint32_t>(request.parameters["number"]);
}

}  // namespace vitrine::server
