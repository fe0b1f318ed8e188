// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/displacement_model.h"

#include <algorithm>

#include "codec/progressive/trained_tables.h"

namespace vitrine {
namespace {

constexpr double kRidge = 4;  // how many splits the start weights count for
constexpr std::uint32_t kSolveEvery = 16;
constexpr double kPriorWeight = 12;  // how many splits a start energy counts for
constexpr double kMemory = 300;      // splits that an error energy remembers

Vec3 unit_or(const Vec3& v, const Vec3& otherwise) {
  const double l = length(v);
  return l > 1e-9 ? v * (1 / l) : otherwise;
}

Vec3 any_perpendicular(const Vec3& n) {
  const Vec3 axis = std::fabs(n.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return unit_or(cross(n, axis), {0, 0, 1});
}

}  // namespace

void DisplacementModel::Regression::start(const double* prior) {
  std::copy_n(prior, kFeatures, weights.begin());
  for (std::size_t k = 0; k < kFeatures; ++k) {
    matrix[k][k] = kRidge;
    right_side[k] = kRidge * prior[k];
  }
}

DisplacementModel::DisplacementModel() {
  tangential_.start(trained::kTangentialWeights);
  normal_.start(trained::kNormalWeights);
  for (std::size_t k = 0; k < energy_.size(); ++k) {
    std::copy_n(trained::kEnergy + 3 * k, 3, energy_[k].begin());
    weight_[k].fill(kPriorWeight);
  }
}

Vec3 DisplacementModel::predict(const SplitSurroundings& s) const {
  Vec3 d;
  for (std::size_t k = 0; k < kFeatures; ++k) {
    const double across = dot(s.features[k], s.normal);
    d += s.features[k] * tangential_.weights[k] +
         s.normal * (across * (normal_.weights[k] - tangential_.weights[k]));
  }
  return d;
}

DisplacementModel::Spread DisplacementModel::spread_of(const SplitSurroundings& s,
                                                       const Vec3& predicted) const {
  Spread spread;
  const Vec3 normal = unit_or(s.normal, {0, 0, 1});
  const Vec3 in_plane = predicted - normal * dot(predicted, normal);
  const Vec3 along = unit_or(in_plane, any_perpendicular(normal));
  spread.frame = {along, normal, cross(normal, along)};
  const auto& energy = energy_[static_cast<std::size_t>(s.context)];
  auto& c = spread.covariance;
  c = {kGrain, 0, 0, kGrain, 0, kGrain};
  for (std::size_t k = 0; k < 3; ++k) {
    const double variance = energy[k] * s.scale * s.scale;
    const Vec3& e = spread.frame[k];
    c[0] += variance * e.x * e.x;
    c[1] += variance * e.x * e.y;
    c[2] += variance * e.x * e.z;
    c[3] += variance * e.y * e.y;
    c[4] += variance * e.y * e.z;
    c[5] += variance * e.z * e.z;
  }
  return spread;
}

void DisplacementModel::learn(const SplitSurroundings& s, const Spread& spread, const Vec3& error,
                              const Vec3& d) {
  const double inverse = 1 / (s.scale * s.scale);
  auto& energy = energy_[static_cast<std::size_t>(s.context)];
  auto& weight = weight_[static_cast<std::size_t>(s.context)];
  for (std::size_t k = 0; k < 3; ++k) {
    const double e = dot(error, spread.frame[k]);
    const double seen = std::min(e * e * inverse, 16.0);
    energy[k] += (seen - energy[k]) / (weight[k] + 1);
    energy[k] = std::max(energy[k], 1e-7);
    weight[k] = std::min(weight[k] + 1, kMemory);
  }
  const double d_normal = dot(d, s.normal);
  std::array<double, kFeatures> f_normal;
  for (std::size_t a = 0; a < kFeatures; ++a)
    f_normal[a] = dot(s.features[a], s.normal);
  for (std::size_t a = 0; a < kFeatures; ++a) {
    const double along_normal = f_normal[a] * d_normal;
    tangential_.right_side[a] += (dot(s.features[a], d) - along_normal) * inverse;
    normal_.right_side[a] += along_normal * inverse;
    for (std::size_t b = 0; b <= a; ++b) {
      const double both_normal = f_normal[a] * f_normal[b];
      tangential_.matrix[a][b] += (dot(s.features[a], s.features[b]) - both_normal) * inverse;
      normal_.matrix[a][b] += both_normal * inverse;
    }
  }
  if (++learned_ % kSolveEvery == 0) {
    tangential_.solve();
    normal_.solve();
  }
}

// Cholesky; the ridge keeps the matrix positive definite.
void DisplacementModel::Regression::solve() {
  std::array<std::array<double, kFeatures>, kFeatures> l{};
  for (std::size_t i = 0; i < kFeatures; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = matrix[i][j];
      for (std::size_t k = 0; k < j; ++k)
        sum -= l[i][k] * l[j][k];
      l[i][j] = i == j ? std::sqrt(std::max(sum, 1e-6)) : sum / l[j][j];
    }
  }
  std::array<double, kFeatures> y{};
  for (std::size_t i = 0; i < kFeatures; ++i) {
    double sum = right_side[i];
    for (std::size_t k = 0; k < i; ++k)
      sum -= l[i][k] * y[k];
    y[i] = sum / l[i][i];
  }
  for (std::size_t i = kFeatures; i-- > 0;) {
    double sum = y[i];
    for (std::size_t k = i + 1; k < kFeatures; ++k)
      sum -= l[k][i] * weights[k];
    // Beyond the range only where hostile splits leave the matrix without a solution.
    const double weight = sum / l[i][i];
    weights[i] = std::fabs(weight) < 1e3 ? weight : 0;
  }
}

}  // namespace vitrine
