// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/displacement_model.h"

#include <algorithm>

#include "codec/coding/trained_tables.h"

namespace vitrine::inline codec {
namespace {

constexpr double kRidge = 4;  // the initial weights count as much as this many splits
constexpr std::uint32_t kSolveEvery = 16;
constexpr double kMemory = 600;  // number of splits over which old evidence fades

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
  static const auto kTangential =
      trained::numbers_of<kKinds * kFeatures>(trained::kTangentialWeights);
  static const auto kNormal = trained::numbers_of<kKinds * kFeatures>(trained::kNormalWeights);
  static const auto kEvidence = trained::numbers_of<kClues * kLevels * 4>(trained::kEvidence);
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    kinds_[kind].tangential.start(&kTangential[kind * kFeatures]);
    kinds_[kind].normal.start(&kNormal[kind * kFeatures]);
  }
  const double* start = kEvidence.data();
  for (auto& clue : evidence_) {
    for (Evidence& e : clue) {
      e = {{start[0], start[1], start[2]}, start[3], kPriorWeight};
      start += 4;
    }
  }
}

Vec3 DisplacementModel::combine(const SplitSurroundings& s) const {
  const KindModel& part = kinds_[s.kind];
  Vec3 d;
  for (std::size_t k = 0; k < kFeatures; ++k) {
    const double across = dot(s.features[k], s.normal);
    const double tangential = part.tangential.weights[k];
    d += s.features[k] * tangential + s.normal * (across * (part.normal.weights[k] - tangential));
  }
  return d;
}

DisplacementModel::ErrorGaussian DisplacementModel::gaussian_of(const SplitSurroundings& s,
                                                                const Vec3& linear) const {
  ErrorGaussian gaussian;
  const Vec3 normal = unit_or(s.normal, {0, 0, 1});
  const Vec3 in_plane = linear - normal * dot(linear, normal);
  const Vec3 along = unit_or(in_plane, any_perpendicular(normal));
  gaussian.frame = {along, normal, cross(normal, along)};
  gaussian.variance.fill(1);
  for (std::size_t clue = 0; clue < kClues; ++clue) {
    const Evidence& e = evidence_[clue][s.clues[clue]];
    for (std::size_t k = 0; k < 3; ++k)
      gaussian.variance[k] *= e.factor[k];
    gaussian.bias += e.bias;
  }
  for (double& v : gaussian.variance)
    v = std::clamp(v, 1e-7, 16.0);
  return gaussian;
}

std::array<double, 6> DisplacementModel::covariance(const SplitSurroundings& s,
                                                    const ErrorGaussian& gaussian) {
  std::array<double, 6> c = {kGrain, 0, 0, kGrain, 0, kGrain};
  for (std::size_t k = 0; k < 3; ++k) {
    const double variance = gaussian.variance[k] * s.scale * s.scale;
    const Vec3& e = gaussian.frame[k];
    c[0] += variance * e.x * e.x;
    c[1] += variance * e.x * e.y;
    c[2] += variance * e.x * e.z;
    c[3] += variance * e.y * e.y;
    c[4] += variance * e.y * e.z;
    c[5] += variance * e.z * e.z;
  }
  return c;
}

void DisplacementModel::learn_gaussian(const SplitSurroundings& s, const ErrorGaussian& gaussian,
                                       const Vec3& error) {
  const double inverse = 1 / (s.scale * s.scale);
  std::array<double, 3> surprise;  // ratio of the observed to the expected variance, minus 1
  for (std::size_t k = 0; k < 3; ++k) {
    const double e = dot(error, gaussian.frame[k]);
    surprise[k] = std::min(e * e * inverse / gaussian.variance[k], 8.0) - 1;
  }
  const double along = std::clamp(dot(error, gaussian.frame[0]) / s.scale, -1.0, 1.0);
  for (std::size_t clue = 0; clue < kClues; ++clue) {
    Evidence& e = evidence_[clue][s.clues[clue]];
    const double rate = 1 / (e.seen + 1);
    for (std::size_t k = 0; k < 3; ++k)
      e.factor[k] = std::clamp(e.factor[k] * (1 + surprise[k] * rate), 1e-3, 1e3);
    e.bias = std::clamp(e.bias + along * rate, -1.0, 1.0);
    e.seen = std::min(e.seen + 1, kMemory);
  }
}

void DisplacementModel::learn_weights(const SplitSurroundings& s, const Vec3& d) {
  KindModel& part = kinds_[s.kind];
  const double inverse = 1 / (s.scale * s.scale);
  const double d_normal = dot(d, s.normal);
  std::array<double, kFeatures> f_normal;
  for (std::size_t a = 0; a < kFeatures; ++a)
    f_normal[a] = dot(s.features[a], s.normal);
  for (std::size_t a = 0; a < kFeatures; ++a) {
    const double along_normal = f_normal[a] * d_normal;
    part.tangential.right_side[a] += (dot(s.features[a], d) - along_normal) * inverse;
    part.normal.right_side[a] += along_normal * inverse;
    for (std::size_t b = 0; b <= a; ++b) {
      const double both_normal = f_normal[a] * f_normal[b];
      part.tangential.matrix[a][b] += (dot(s.features[a], s.features[b]) - both_normal) * inverse;
      part.normal.matrix[a][b] += both_normal * inverse;
    }
  }
  if (++part.learned % kSolveEvery == 0) {
    part.tangential.solve();
    part.normal.solve();
  }
}

// Solves the equations by Cholesky decomposition. The ridge keeps the matrix positive definite.
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
    // The weight is out of range only if hostile splits make the matrix singular.
    const double weight = sum / l[i][i];
    weights[i] = std::fabs(weight) < 1e3 ? weight : 0;
  }
}

}  // namespace vitrine::inline codec
