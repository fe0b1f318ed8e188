// SPDX-License-Identifier: Apache-2.0
// Typed, bounds-checked access to the arrays of numbers in a glTF file.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "codec/gltf/gltf_buffer.h"

namespace vitrine::inline codec {

// An array of vectors with `width` components each. The starts of successive vectors are `stride`
// bytes apart. Sparse values replace some of the vectors.
class Accessor {
 public:
  // Opens the accessor number `index`. If the values do not fit their buffer view with the stated
  // byte stride, but fit without gaps, reads them without gaps. Fails if the values extend beyond
  // the view.
  //
  // `needed` is the number of values to which indices refer, or 0 if unknown. Some exporters state
  // a wrong count. If the stated count is smaller than `needed` or exceeds the view, the accessor
  // gets `needed` values, provided that the view holds them.
  static Expected<Accessor> open(const Json& document, GltfBuffer& buffer, std::uint64_t index,
                                 std::uint64_t needed = 0);

  // Opens the accessor number `index`, but reads from `values` instead of a buffer view. `values`
  // is the decompressed data of a primitive, stored without gaps. Computes the number of values
  // from the size of the data, because some exporters state a wrong count.
  static Expected<Accessor> over(const Json& document, std::span<const std::uint8_t> values,
                                 std::uint64_t index);

  std::uint64_t count() const { return count_; }
  std::uint32_t width() const { return width_; }
  bool is_whole() const { return type_ != kFloat; }  // whether components are integers
  // Whether the stated count or byte stride was wrong and was corrected.
  bool is_corrected() const { return is_corrected_; }
  // Treats integers as normalised. Returns false without any effect if the file already marks them
  // as normalised, or if the components are not integers of 8 or 16 bits.
  bool normalise();
  // Returns component k of vector i. Integers are normalised if the file says so.
  double real(std::uint64_t i, std::uint32_t k) const;
  // Returns the first component of vector i. The component type must be an unsigned integer.
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

  // Returns an accessor that has the type, width and count stated in the document, but no values
  // yet.
  static Expected<Accessor> described(const Json& document, std::uint64_t index);

 private:
  // The sparse values of an accessor, which replace values of its buffer view. Their indices
  // ascend.
  struct Sparse {
    std::uint64_t count = 0;
    Type type = kUint;  // component type of the indices
    std::span<const std::uint8_t> indices, values;

    std::uint64_t index(std::uint64_t i) const;
    // Returns the position in the sparse list of the first value whose index is at least i, or
    // `count` if there is none.
    std::uint64_t find(std::uint64_t i) const;
  };

  Expected<void> place(const BufferView& view, std::uint64_t begin, std::uint64_t index,
                       std::uint64_t needed);
  Expected<void> open_sparse(const Json& sparse, GltfBuffer& buffer, std::uint64_t index);
  std::uint64_t value_bytes() const { return std::uint64_t{byte_size(type_)} * width_; }
  // Returns the bytes of vector i.
  const std::uint8_t* at(std::uint64_t i) const;

  std::span<const std::uint8_t> bytes_;  // empty if all values are zero or sparse
  Sparse sparse_;
  std::uint64_t count_ = 0, stride_ = 0;
  std::uint32_t width_ = 0;
  Type type_ = kFloat;
  bool is_normalised_ = false, is_corrected_ = false;
};

}  // namespace vitrine::inline codec
