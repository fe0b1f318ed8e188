// SPDX-License-Identifier: Apache-2.0
// The name of a model: a ULID, 48 bits of milliseconds since 1970 and 80 random bits, written as 26
// lower-case digits of Crockford's base 32. Ids sort by age. A user's text becomes an id only
// through `parse`, so no such text ever reaches a path or a query.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vitrine {

class ModelId {
 public:
  ModelId() = default;  // all zero: no model has this id

  static ModelId generate();
  static std::optional<ModelId> parse(std::string_view text) noexcept;  // 26 digits, lower case
  static ModelId from_bytes(const std::array<std::uint8_t, 16>& bytes) { return ModelId(bytes); }

  std::string to_string() const;
  const std::array<std::uint8_t, 16>& bytes() const { return bytes_; }
  auto operator<=>(const ModelId&) const = default;

 private:
  explicit ModelId(const std::array<std::uint8_t, 16>& bytes) : bytes_(bytes) {}

  std::array<std::uint8_t, 16> bytes_{};  // big-endian
};

}  // namespace vitrine
