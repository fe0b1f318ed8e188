// SPDX-License-Identifier: Apache-2.0
// Solves A x = b for a symmetric positive definite A by conjugate gradients with the diagonal as
// preconditioner ([Shewchuk94] section B3). Each unknown is a point of the plane.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/vec2.h"

namespace vitrine::inline codec {

inline double dot(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += dot(a[i], b[i]);
  return sum;
}

struct StoppingRule {
  int iterations;
  // Stop once the norm of the preconditioned residual has fallen to this fraction of its first
  // value.
  double reduction;
};

// Improves `x` in place. `residual` is b - A x. `diagonal` is the diagonal of A, with one entry per
// unknown. apply(p) returns A * p. At fixed unknowns, `residual` and the result of apply() must be
// zero.
template <class Apply>
void conjugate_gradients(const Apply& apply, const std::vector<double>& diagonal,
                         std::vector<Vec2> residual, std::vector<Vec2>& x,
                         const StoppingRule& stop) {
  const auto precondition = [&](const std::vector<Vec2>& r) {
    std::vector<Vec2> z(r.size());
    for (std::size_t i = 0; i < r.size(); ++i)
      z[i] = diagonal[i] > 0 ? r[i] * (1 / diagonal[i]) : r[i];
    return z;
  };
  std::vector<Vec2> z = precondition(residual), direction = z;
  double rz = dot(residual, z);
  const double goal = rz * stop.reduction * stop.reduction;
  for (int i = 0; i < stop.iterations && rz > goal; ++i) {
    const std::vector<Vec2> image = apply(direction);
    const double curvature = dot(direction, image);
    if (!(curvature > 0)) return;
    const double step = rz / curvature;
    for (std::size_t j = 0; j < x.size(); ++j) {
      x[j] = x[j] + direction[j] * step;
      residual[j] = residual[j] - image[j] * step;
    }
    z = precondition(residual);
    const double ratio = dot(residual, z) / rz;
    rz *= ratio;
    for (std::size_t j = 0; j < x.size(); ++j)
      direction[j] = z[j] + direction[j] * ratio;
  }
}

}  // namespace vitrine::inline codec
