// SPDX-License-Identifier: Apache-2.0
// Adaptive models for inserted components: how their faces connect and where their vertices are.
// NumberModel also codes texture coordinates of base meshes.
// All probabilities start at one half, except those of ResidualCoder, which start at trained
// values.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "codec/coding/residual_coder.h"
#include "codec/core/range_coder.h"
#include "codec/core/vec.h"
#include "codec/mesh/vertex_attributes.h"

namespace vitrine::inline codec {

// Codes an integer, given a prediction. The model's standard deviation follows the running mean
// square of the prediction error.
class NumberModel {
 public:
  template <class Coder>
  std::int32_t code(Coder& coder, double expected, std::int32_t truth) {
    const std::int32_t value = coder_.code(coder, truth, expected, std::sqrt(energy_ + 0.05));
    const double error = static_cast<double>(value) - expected;
    energy_ += (error * error - energy_) / std::min(++seen_, kMemory);
    return value;
  }

 private:
  static constexpr double kMemory = 24;
  double energy_ = 64, seen_ = 1;
  ResidualCoder coder_;
};

// Codes three integers, each with its own model.
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
  std::array<NumberModel, 3> axes_;
};

// Codes whether a face lies across an open edge, and which vertex completes that face.
class GateModel {
 public:
  // Codes whether the open edge is a boundary edge, which has no face on its other side. `faces` is
  // the number of the component's faces coded so far.
  template <class Coder>
  bool code_boundary(Coder& coder, std::size_t faces, bool truth) {
    return coder.bit(boundary_[context(faces)], truth ? 1 : 0) != 0;
  }
  template <class Coder>
  bool code_new(Coder& coder, std::size_t faces, bool truth) {
    return coder.bit(new_[context(faces)], truth ? 1 : 0) != 0;
  }
  // Codes whether a given vertex is the third vertex of the new face. `sides` is the number (0 to
  // 2) of the face's other two edges that would then connect to existing faces.
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

// Models for the first vertex of a component and for all other vertices.
struct VertexModel {
  TripleModel first, other;
};

struct ComponentModel {
  GateModel gates;
  VertexModel cells;
  std::array<VertexModel, kSemantics> attributes;  // one entry per attribute of the mesh
};

}  // namespace vitrine::inline codec
