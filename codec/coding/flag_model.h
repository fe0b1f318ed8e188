// SPDX-License-Identifier: Apache-2.0
// Codes whether a vertex splits in a level, one flag per vertex.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "codec/core/exact_math.h"
#include "codec/core/range_coder.h"

namespace vitrine::inline codec {

struct FlagFeatures {
  // Whether the vertex has a neighbour in another region. If so, the model uses only `age`.
  bool is_border = false;
  int age = 1;  // levels since the last split of the vertex, >= 1
  int valence = 6;
  int unsplit = 0;           // neighbours visited earlier in this level that did not split
  int split = 0;             // neighbours visited earlier in this level that split
  double square_length = 0;  // mean squared edge length to non-virtual neighbours
};

class FlagModel {
 public:
  FlagModel();

  template <class Coder>
  bool code(Coder& coder, const FlagFeatures& f, bool truth) {
    const bool split =
        coder.bit(bits_[f.is_border ? border_context(f) : context(f)], truth ? 1 : 0) != 0;
    if (!f.is_border) average_ += (f.square_length - average_) / std::min(++seen_, kMemory);
    return split;
  }

  static constexpr std::size_t kBorderBits = 4, kBits = kBorderBits + 8 * 9 * 8 * 2;
  const std::array<AdaptiveBit, kBits>& bits() const { return bits_; }

 private:
  static constexpr double kMemory = 200;

  static std::size_t border_context(const FlagFeatures& f) {
    return static_cast<std::size_t>(std::clamp(f.age, 1, 4) - 1);
  }

  std::size_t context(const FlagFeatures& f) {
    if (seen_ == 0) average_ = f.square_length;
    const double ratio = (f.square_length + 0.01) / (average_ + 0.01);
    const int length = std::clamp(exact::log2_bucket<1>(ratio) + 4, 0, 7);
    const int valence = std::clamp(f.valence - 3, 0, 7);
    const int around = std::min(f.unsplit, 2) * 3 + std::min(f.split, 2);
    const int age = std::min(f.age, 2) - 1;
    return kBorderBits + static_cast<std::size_t>(((valence * 9 + around) * 8 + length) * 2 + age);
  }

  double average_ = 0;
  double seen_ = 0;
  std::array<AdaptiveBit, kBits> bits_;
};

}  // namespace vitrine::inline codec
