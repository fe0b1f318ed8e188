// SPDX-License-Identifier: Apache-2.0
// Separate types for the IDs of models, jobs, scans, uploads and tokens, so that IDs of different
// kinds cannot be confused. An ID is a ULID: 48 bits of milliseconds since 1970 and 80 random bits,
// written as 26 lower-case digits of Crockford's base 32. IDs sort by time of creation. Text from a
// client becomes an ID only through `parse`, so that unchecked text never reaches a path or a
// query.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vitrine::server {

using Ulid = std::array<std::uint8_t, 16>;  // big-endian

Ulid generate_ulid();
// Returns nullopt if `text` is not 26 lower-case digits, or if its value exceeds 128 bits.
std::optional<Ulid> parse_ulid(std::string_view text) noexcept;
std::string to_string(const Ulid& ulid);

template <class Tag>
class Id {
 public:
  Id() = default;  // all bytes are zero; no object has this ID

  static Id generate() { return Id(generate_ulid()); }
  static std::optional<Id> parse(std::string_view text) noexcept {
    const auto ulid = parse_ulid(text);
    return ulid ? std::optional(Id(*ulid)) : std::nullopt;
  }
  static Id from_bytes(const Ulid& bytes) { return Id(bytes); }

  std::string to_string() const { return server::to_string(bytes_); }
  const Ulid& bytes() const { return bytes_; }
  auto operator<=>(const Id&) const = default;

 private:
  explicit Id(const Ulid& bytes) : bytes_(bytes) {}

  Ulid bytes_{};
};

using ModelId = Id<struct ModelTag>;
using JobId = Id<struct JobTag>;
using ScanId = Id<struct ScanTag>;
using UploadId = Id<struct UploadTag>;
using TokenId = Id<struct TokenTag>;

}  // namespace vitrine::server
