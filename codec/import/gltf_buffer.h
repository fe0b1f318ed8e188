// SPDX-License-Identifier: Apache-2.0
// Typed and bounded access to the numbers of a binary glTF file.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine {

using Json = nlohmann::json;

// The member `key`, or null where `object` is no object or has none.
const Json& member(const Json& object, std::string_view key);

// Element `index` of the array `key` of the document, or null.
const Json& element(const Json& document, std::string_view key, std::uint64_t index);

// A member as a whole number from 0, `otherwise` where it is absent or something else.
std::uint64_t whole(const Json& object, std::string_view key, std::uint64_t otherwise);

inline constexpr std::uint64_t kAbsent = ~std::uint64_t{0};

// Vectors of `width` components, `stride` bytes apart.
class Accessor {
 public:
  // Fails unless accessor `index` lies within the binary chunk `buffer`.
  static Expected<Accessor> open(const Json& document, std::span<const std::uint8_t> buffer,
                                 std::uint64_t index);

  std::uint64_t count() const { return count_; }
  std::uint32_t width() const { return width_; }
  bool is_whole() const { return type_ != kFloat; }     // components are integers
  double real(std::uint64_t i, std::uint32_t k) const;  // normalised where the file says so
  std::uint32_t index(std::uint64_t i) const;           // of an unsigned integer type

 private:
  enum Type : std::uint32_t {
    kByte = 5120,
    kUbyte = 5121,
    kShort = 5122,
    kUshort = 5123,
    kUint = 5125,
    kFloat = 5126
  };
  static std::uint32_t byte_size(Type type);
  static std::uint32_t width_of(std::string_view type);

  std::span<const std::uint8_t> bytes_;
  std::uint64_t count_ = 0, stride_ = 0;
  std::uint32_t width_ = 0;
  Type type_ = kFloat;
  bool normalised_ = false;
};

}  // namespace vitrine
