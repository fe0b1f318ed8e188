// SPDX-License-Identifier: Apache-2.0
// Typed, bounds-checked access to the numbers of a glTF file.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "codec/gltf/gltf_buffer.h"

namespace vitrine::inline codec {

// A sequence of vectors with `width` components each. Successive vectors begin `stride` bytes
// apart.
class Accessor {
 public:
  // Opens accessor `index`. Fails unless it lies within its buffer view.
  static Expected<Accessor> open(const Json& document, GltfBuffer& buffer, std::uint64_t index);

  // Opens accessor `index`, but takes its values from `values`, the decompressed data of a
  // primitive, without gaps. Their number replaces the stated count, which exporters get wrong.
  static Expected<Accessor> over(const Json& document, std::span<const std::uint8_t> values,
                                 std::uint64_t index);

  std::uint64_t count() const { return count_; }
  std::uint32_t width() const { return width_; }
  bool is_whole() const { return type_ != kFloat; }  // whether the components are integers
  // Returns component k of vector i, normalised if the file says so.
  double real(std::uint64_t i, std::uint32_t k) const;
  // Returns the first component of vector i, which must have an unsigned integer type.
  std::uint32_t index(std::uint64_t i) const;

  enum Type : std::uint32_t {
    kByte = 5120,
    kUbyte = 5121,
    kShort = 5122,
    kUshort = 5123,
    kUint = 5125,
    kFloat = 5126
  };
  Type type() const { return type_; }
  static std::uint32_t byte_size(Type type);  // 0 if the type is unknown

  // Returns an accessor without values that has the type, width and count stated in the document.
  static Expected<Accessor> described(const Json& document, std::uint64_t index);

 private:
  Expected<void> place(const BufferView& view, std::uint64_t begin, std::uint64_t index);

  std::span<const std::uint8_t> bytes_;
  std::uint64_t count_ = 0, stride_ = 0;
  std::uint32_t width_ = 0;
  Type type_ = kFloat;
  bool is_normalised_ = false;
};

}  // namespace vitrine::inline codec
