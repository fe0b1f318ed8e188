// SPDX-License-Identifier: Apache-2.0
// Typed and bounded access to the numbers of a binary glTF file.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "codec/import/gltf_buffer.h"

namespace vitrine {

// Vectors of `width` components, `stride` bytes apart.
class Accessor {
 public:
  // Fails unless accessor `index` lies within its buffer view.
  static Expected<Accessor> open(const Json& document, GltfBuffer& buffer, std::uint64_t index);

  // Accessor `index` over `values`, which holds all of them without gaps: a decompressed primitive.
  static Expected<Accessor> over(const Json& document, std::span<const std::uint8_t> values,
                                 std::uint64_t index);

  std::uint64_t count() const { return count_; }
  std::uint32_t width() const { return width_; }
  bool is_whole() const { return type_ != kFloat; }     // components are integers
  double real(std::uint64_t i, std::uint32_t k) const;  // normalised where the file says so
  std::uint32_t index(std::uint64_t i) const;           // of an unsigned integer type

  enum Type : std::uint32_t {
    kByte = 5120,
    kUbyte = 5121,
    kShort = 5122,
    kUshort = 5123,
    kUint = 5125,
    kFloat = 5126
  };
  Type type() const { return type_; }
  static std::uint32_t byte_size(Type type);  // 0 where the type is unknown

  // Type, width and count as the document states them, without any values.
  static Expected<Accessor> described(const Json& document, std::uint64_t index);

 private:
  Expected<void> place(const BufferView& view, std::uint64_t begin, std::uint64_t index);

  std::span<const std::uint8_t> bytes_;
  std::uint64_t count_ = 0, stride_ = 0;
  std::uint32_t width_ = 0;
  Type type_ = kFloat;
  bool normalised_ = false;
};

}  // namespace vitrine
