// SPDX-License-Identifier: Apache-2.0
#include "server/backup/checksums.h"

#include <fmt/format.h>

#include <algorithm>

namespace vitrine::server {
namespace {

constexpr std::string_view kBetween = "  ";
constexpr std::size_t kDigits = 64;

}  // namespace

std::string object_path(const Sha256& name) {
  const std::string hex = to_hex(name);
  return fmt::format("objects/{}/{}/{}", hex.substr(0, 2), hex.substr(2, 2), hex);
}

std::string to_text(const Checksums& sums) {
  std::string text;
  for (const auto& [name, hash] : sums)
    text += fmt::format("{}{}{}\n", to_hex(hash), kBetween, name);
  return text;
}

std::optional<Checksums> parse_checksums(std::span<const std::uint8_t> bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  Checksums sums;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    Sha256 hash{};
    const bool reads = line.size() > kDigits + kBetween.size() &&
                       from_hex(line.substr(0, kDigits), hash) &&
                       line.substr(kDigits, kBetween.size()) == kBetween;
    if (!reads) return std::nullopt;
    if (!sums.emplace(line.substr(kDigits + kBetween.size()), hash).second) return std::nullopt;
  }
  return sums;
}

}  // namespace vitrine::server
