// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/displacement_model.h"

#include <algorithm>
#include <utility>

#include "codec/coding/trained_tables.h"

namespace vitrine::inline codec {
namespace {

// Weight of the prior of the ridge regression, which is the trained weights.
constexpr double kRidge = 4;
constexpr std::uint32_t kSolveEvery = 16;
constexpr double kMemory = 600;  // number of splits after which older evidence fades

// Same as std::clamp, but compiles to two instructions without a branch.
double bounded(double x, double low, double high) {
  return std::min(std::max(x, low), high);
}

Vec3 unit_or(const Vec3& v, const Vec3& otherwise) {
  const double l = length(v);
  return l > 1e-9 ? v * (1 / l) : otherwise;
}

Vec3 any_perpendicular(const Vec3& n) {
  const Vec3 axis = std::fabs(n.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return unit_or(cross(n, axis), {0, 0, 1});
}

}  // namespace

void DisplacementModel::Regression::start(const double* tangential_prior,
                                          const double* normal_prior) {
  std::copy_n(tangential_prior, kFeatures, tangential.begin());
  std::copy_n(normal_prior, kFeatures, normal.begin());
  for (std::size_t k = 0; k < kFeatures; ++k) {
    matrix[k][k] = both(kRidge);
    right_side[k] = kRidge * Double2{tangential[k], normal[k]};
  }
}

DisplacementModel::DisplacementModel() {
  static const auto kTangential =
      trained::numbers_of<kKinds * kFeatures>(trained::kTangentialWeights);
  static const auto kNormal = trained::numbers_of<kKinds * kFeatures>(trained::kNormalWeights);
  static const auto kEvidence = trained::numbers_of<kClues * kLevels * 4>(trained::kEvidence);
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    kinds_[kind].start(&kTangential[kind * kFeatures], &kNormal[kind * kFeatures]);
  }
  const double* start = kEvidence.data();
  for (auto& clue : evidence_) {
    for (Evidence& e : clue) {
      e = {{start[0], start[1], start[2]}, start[3], kPriorWeight};
      start += 4;
    }
  }
}

DisplacementModel::FeatureColumns DisplacementModel::columns_of(const SplitSurroundings& s) {
  FeatureColumns columns;
  for (auto* column : {&columns.x, &columns.y, &columns.z, &columns.normal})
    column->back() = 0;
  for (std::size_t k = 0; k < kFeatures; ++k) {
    const Vec3& f = s.features[k];
    columns.x[k] = f.x, columns.y[k] = f.y, columns.z[k] = f.z;
    columns.normal[k] = dot(f, s.normal);
  }
  return columns;
}

Vec3 DisplacementModel::combine(const SplitSurroundings& s, const FeatureColumns& columns) const {
  const Regression& part = kinds_[s.kind];
  Vec3 d;
  for (std::size_t k = 0; k < kFeatures; ++k) {
    const double tangential = part.tangential[k];
    d +=
        s.features[k] * tangential + s.normal * (columns.normal[k] * (part.normal[k] - tangential));
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
  std::array<double, 3> surprise;  // per axis: observed divided by expected variance, minus 1
  for (std::size_t k = 0; k < 3; ++k) {
    const double e = dot(error, gaussian.frame[k]);
    surprise[k] = std::min(e * e * inverse / gaussian.variance[k], 8.0) - 1;
  }
  const double along = std::clamp(dot(error, gaussian.frame[0]) / s.scale, -1.0, 1.0);
  for (std::size_t clue = 0; clue < kClues; ++clue) {
    Evidence& e = evidence_[clue][s.clues[clue]];
    const double rate = 1 / (e.seen + 1);
    for (std::size_t k = 0; k < 3; ++k)
      e.factor[k] = bounded(e.factor[k] * (1 + surprise[k] * rate), 1e-3, 1e3);
    e.bias = bounded(e.bias + along * rate, -1.0, 1.0);
    e.seen = std::min(e.seen + 1, kMemory);
  }
}

void DisplacementModel::learn_weights(const SplitSurroundings& s, const FeatureColumns& columns,
                                      const Vec3& d) {
  Regression& part = kinds_[s.kind];
  const double inverse = 1 / (s.scale * s.scale);
  const double d_normal = dot(d, s.normal);
  const FeatureColumns& f = columns;
  // The index `a` is a template parameter, which lets the compiler unroll the inner loop.
  const auto add_row = [&]<std::size_t a>(std::integral_constant<std::size_t, a>) {
    const double along_normal = f.normal[a] * d_normal;
    part.right_side[a] += Double2{dot(s.features[a], d) - along_normal, along_normal} * inverse;
    for (std::size_t b = 0; b <= a; b += 2) {
      const Double2 along = f.normal[a] * load2(&f.normal[b]);
      const Double2 across =
          f.x[a] * load2(&f.x[b]) + f.y[a] * load2(&f.y[b]) + f.z[a] * load2(&f.z[b]) - along;
      part.matrix[a][b] += Double2{across[0], along[0]} * inverse;
      part.matrix[a][b + 1] += Double2{across[1], along[1]} * inverse;
    }
  };
  [&]<std::size_t... a>(std::index_sequence<a...>) {
    (add_row(std::integral_constant<std::size_t, a>{}), ...);
  }
  (std::make_index_sequence<kFeatures>{});
  if (++part.learned % kSolveEvery == 0) part.solve();
}

// Solves the equations by Cholesky decomposition. The ridge term keeps the matrix positive
// definite.
void DisplacementModel::Regression::solve() {
  std::array<std::array<Double2, kFeatures>, kFeatures> l;
  for (std::size_t i = 0; i < kFeatures; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      Double2 sum = matrix[i][j];
      for (std::size_t k = 0; k < j; ++k)
        sum -= l[i][k] * l[j][k];
      l[i][j] = i == j ? sqrt(max(sum, both(1e-6))) : sum / l[j][j];
    }
  }
  std::array<Double2, kFeatures> y;
  for (std::size_t i = 0; i < kFeatures; ++i) {
    Double2 sum = right_side[i];
    for (std::size_t k = 0; k < i; ++k)
      sum -= l[i][k] * y[k];
    y[i] = sum / l[i][i];
  }
  for (std::size_t i = kFeatures; i-- > 0;) {
    Double2 sum = y[i];
    for (std::size_t k = i + 1; k < kFeatures; ++k)
      sum -= l[k][i] * Double2{tangential[k], normal[k]};
    // A weight exceeds 1,000 only if hostile splits make the matrix singular. It is then replaced
    // by 0.
    const Double2 weight = sum / l[i][i];
    const Double2 safe = abs(weight) < both(1e3) ? weight : both(0);
    tangential[i] = safe[0], normal[i] = safe[1];
  }
}

}  // namespace vitrine::inline codec
