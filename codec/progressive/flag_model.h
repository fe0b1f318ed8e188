// SPDX-License-Identifier: Apache-2.0
// Whether a vertex splits in this level.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "codec/core/exact_math.h"
#include "codec/core/range_coder.h"

namespace vitrine {

struct FlagFeatures {
  bool border = false;  // next to another region: only `age` may be used
  int age = 1;          // levels since the vertex last split, >= 1
  int valence = 6;
  int unsplit = 0;           // neighbours already visited in this level that did not split
  int split = 0;             // neighbours already visited that did
  double square_length = 0;  // mean squared length of the edges to the real neighbours
};

class FlagModel {
 public:
  template <class Coder>
  bool code(Coder& coder, const FlagFeatures& f, bool truth) {
    AdaptiveBit& bit = f.border ? border_[std::clamp(f.age, 1, 4) - 1] : context(f);
    const bool split = coder.bit(bit, truth ? 1 : 0) != 0;
    if (!f.border) average_ += (f.square_length - average_) / std::min(++seen_, kMemory);
    return split;
  }

 private:
  static constexpr double kMemory = 200;

  AdaptiveBit& context(const FlagFeatures& f) {
    if (seen_ == 0) average_ = f.square_length;
    const double ratio = (f.square_length + 0.01) / (average_ + 0.01);
    const int length = std::clamp(exact::log2_bucket<1>(ratio) + 5, 0, 9);
    const int valence = std::clamp(f.valence - 3, 0, 7);
    const int around = std::min(f.unsplit, 2) * 3 + std::min(f.split, 2);
    return bits_[valence][around][length][std::min(f.age, 2) - 1];
  }

  double average_ = 0;
  double seen_ = 0;
  std::array<AdaptiveBit, 4> border_;
  std::array<std::array<std::array<std::array<AdaptiveBit, 2>, 10>, 9>, 8> bits_;
};

}  // namespace vitrine
