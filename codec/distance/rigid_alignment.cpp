// SPDX-License-Identifier: Apache-2.0
#include "codec/distance/rigid_alignment.h"

#include <cmath>
#include <vector>

namespace vitrine::inline codec {
namespace {

constexpr int kMaxIterations = 100;
// The alignment stops once an iteration lowers the mean squared distance by less than this share.
constexpr double kConverged = 1e-7;

using Matrix4 = std::array<std::array<double, 4>, 4>;

void rotate(Matrix4& a, Matrix4& vectors, std::size_t p, std::size_t q) {
  if (a[p][q] == 0) return;
  const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  for (std::size_t k = 0; k < 4; ++k) {
    const double x = a[k][p], y = a[k][q];
    a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const double x = a[p][k], y = a[q][k];
    a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const double x = vectors[k][p], y = vectors[k][q];
    vectors[k][p] = c * x - s * y, vectors[k][q] = s * x + c * y;
  }
}

// Returns the eigenvector for the largest eigenvalue of a symmetric matrix. Uses Jacobi rotations.
std::array<double, 4> top_eigenvector(Matrix4 a) {
  Matrix4 vectors{};
  for (std::size_t k = 0; k < 4; ++k)
    vectors[k][k] = 1;
  for (int sweep = 0; sweep < 16; ++sweep) {
    for (std::size_t p = 0; p < 4; ++p) {
      for (std::size_t q = p + 1; q < 4; ++q)
        rotate(a, vectors, p, q);
    }
  }
  std::size_t top = 0;
  for (std::size_t k = 1; k < 4; ++k) {
    if (a[k][k] > a[top][top]) top = k;
  }
  return {vectors[0][top], vectors[1][top], vectors[2][top], vectors[3][top]};
}

std::array<Vec3, 3> rotation(const std::array<double, 4>& q) {
  const auto [w, x, y, z] = q;
  return {Vec3{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
          Vec3{2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
          Vec3{2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
}

Vec3 mean(std::span<const Vec3> points) {
  Vec3 sum;
  for (const Vec3& p : points)
    sum += p;
  return sum * (1 / static_cast<double>(points.size()));
}

}  // namespace

RigidMotion then(const RigidMotion& first, const RigidMotion& second) {
  RigidMotion both;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& r = second.rows[k];
    both.rows[k] = first.rows[0] * r.x + first.rows[1] * r.y + first.rows[2] * r.z;
  }
  both.shift = second(first.shift);
  return both;
}

RigidMotion fit_motion(std::span<const Vec3> from, std::span<const Vec3> to) {
  if (from.empty()) return {};
  const Vec3 a = mean(from), b = mean(to);
  std::array<Vec3, 3> m{};  // sum over all points of the outer product from * to^T, row by row
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vec3 p = from[i] - a, q = to[i] - b;
    m[0] += q * p.x, m[1] += q * p.y, m[2] += q * p.z;
  }
  const auto& [x, y, z] = m;
  const Matrix4 n = {{{x.x + y.y + z.z, y.z - z.y, z.x - x.z, x.y - y.x},
                      {y.z - z.y, x.x - y.y - z.z, x.y + y.x, z.x + x.z},
                      {z.x - x.z, x.y + y.x, y.y - x.x - z.z, y.z + z.y},
                      {x.y - y.x, z.x + x.z, y.z + z.y, z.z - x.x - y.y}}};
  RigidMotion motion{rotation(top_eigenvector(n)), {}};
  motion.shift = b - motion(a);
  return motion;
}

RigidMotion align(std::span<const Vec3> points, const TriangleBvh& surface) {
  RigidMotion motion;
  if (points.empty() || surface.empty()) return motion;
  std::vector<Vec3> moved(points.begin(), points.end()), target(points.size());
  std::vector<std::uint32_t> last(points.size(), 0);
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxIterations; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < moved.size(); ++k) {
      const double bound = squared_distance(surface.triangle(last[k]), moved[k]);
      const ClosestTriangle hit = surface.closest(moved[k], {bound, last[k]});
      last[k] = hit.triangle;
      target[k] = closest_point(surface.triangle(hit.triangle), moved[k]);
      sum += hit.squared;
    }
    if (!(sum < before * (1 - kConverged))) break;
    before = sum;
    const RigidMotion step = fit_motion(moved, target);
    motion = then(motion, step);
    for (std::size_t k = 0; k < moved.size(); ++k)
      moved[k] = motion(points[k]);
  }
  return motion;
}

}  // namespace vitrine::inline codec
