// SPDX-License-Identifier: Apache-2.0
// Adaptive models of components that are born whole: how their faces join and where their vertices
// are. Their bits start even but for residuals, which start as those of splits do.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "codec/core/range_coder.h"
#include "codec/core/vec.h"
#include "codec/progressive/residual_coder.h"

namespace vitrine {

// A triple of integers, given what it may be. The width follows the running mean square of the
// error, per axis.
class TripleModel {
 public:
  template <class Coder>
  Vec3i code(Coder& coder, const Vec3i& expected, const Vec3i& truth) {
    Vec3i out;
    out.x = axes_[0].code(coder, expected.x, truth.x);
    out.y = axes_[1].code(coder, expected.y, truth.y);
    out.z = axes_[2].code(coder, expected.z, truth.z);
    return out;
  }

 private:
  struct Axis {
    template <class Coder>
    std::int32_t code(Coder& coder, std::int32_t expected, std::int32_t truth) {
      const std::int32_t value = coder_.code(coder, truth, expected, std::sqrt(energy_ + 0.05));
      const double error = static_cast<double>(value) - expected;
      energy_ += (error * error - energy_) / std::min(++seen_, kMemory);
      return value;
    }

    static constexpr double kMemory = 24;
    double energy_ = 64, seen_ = 1;
    ResidualCoder coder_;
  };

  std::array<Axis, 3> axes_;
};

// Which face, if any, is behind an edge of those that are known.
class GateModel {
 public:
  // `faces` the component has so far.
  template <class Coder>
  bool code_boundary(Coder& coder, std::size_t faces, bool truth) {
    return coder.bit(boundary_[context(faces)], truth ? 1 : 0) != 0;
  }
  template <class Coder>
  bool code_new(Coder& coder, std::size_t faces, bool truth) {
    return coder.bit(new_[context(faces)], truth ? 1 : 0) != 0;
  }
  // Whether the face ends at a known vertex; `sides` of its other edges would meet one, 0 to 2.
  template <class Coder>
  bool code_known(Coder& coder, int sides, bool truth) {
    return coder.bit(known_[static_cast<std::size_t>(sides)], truth ? 1 : 0) != 0;
  }

 private:
  static constexpr std::size_t kFaces = 16;
  static std::size_t context(std::size_t faces) { return std::min(faces, kFaces) - 1; }

  std::array<AdaptiveBit, kFaces> boundary_, new_;
  std::array<AdaptiveBit, 3> known_;
};

struct BirthModel {
  GateModel gates;
  TripleModel first, other;                // cells
  TripleModel first_colour, other_colour;  // YCoCg-R
};

}  // namespace vitrine
