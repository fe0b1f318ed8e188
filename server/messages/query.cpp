// SPDX-License-Identifier: Apache-2.0
#include "server/messages/query.h"

#include <algorithm>
#include <charconv>

namespace vitrine::server {
namespace {

std::optional<std::string> percent_decode(std::string_view text, char plus) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i] == '+' ? plus : text[i];
      continue;
    }
    unsigned value = 0;
    const std::string_view digits = text.substr(i + 1, 2);
    const auto [end, fault] =
        std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (fault != std::errc{} || digits.size() < 2 || end != digits.data() + 2) return std::nullopt;
    out += static_cast<char>(value);
    i += 2;
  }
  return out;
}

}  // namespace

std::optional<RequestTarget> split_target(std::string_view target) {
  if (const std::size_t scheme = target.find("://");
      scheme != std::string_view::npos && scheme < target.find('/')) {
    target.remove_prefix(std::min(target.size(), target.find('/', scheme + 3)));
  }
  if (!target.starts_with('/')) return std::nullopt;
  const std::size_t mark = std::min(target.size(), target.find('?'));
  return RequestTarget{target.substr(0, mark), target.substr(std::min(target.size(), mark + 1))};
}

std::optional<std::string> decode_path(std::string_view text) {
  return percent_decode(text, '+');
}

std::optional<Query> Query::parse(std::string_view text) {
  Query query;
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(text.size(), pair.size() + 1));
    if (pair.empty()) continue;
    const std::string_view name = pair.substr(0, pair.find('='));
    auto key = percent_decode(name, ' ');
    auto value = percent_decode(pair.substr(std::min(pair.size(), name.size() + 1)), ' ');
    if (!key || !value || query.parameters_.size() == kMaxParameters) return std::nullopt;
    query.parameters_.emplace_back(std::move(*key), std::move(*value));
  }
  return query;
}

std::optional<std::string_view> Query::get(std::string_view name) const {
  for (const auto& [key, value] : parameters_) {
    if (key == name) return value;
  }
  return std::nullopt;
}

std::optional<std::string_view> Query::repeated() const {
  for (auto at = parameters_.begin(); at != parameters_.end(); ++at) {
    const auto is_same = [&](const auto& other) { return other.first == at->first; };
    if (std::any_of(parameters_.begin(), at, is_same)) return at->first;
  }
  return std::nullopt;
}

std::optional<std::string_view> Query::unknown(std::span<const std::string_view> known) const {
  for (const auto& [key, value] : parameters_) {
    if (std::ranges::find(known, key) == known.end()) return key;
  }
  return std::nullopt;
}

}  // namespace vitrine::server
