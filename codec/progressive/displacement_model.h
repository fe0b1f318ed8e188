// SPDX-License-Identifier: Apache-2.0
// D = V1 - V2 of a vertex split: predicted as a combination of features of the fine one-rings whose
// weights are learned online (recursive least squares), its error modelled as a Gaussian in the
// frame (predicted direction, normal, across) and coded axis by axis, each conditional on the last.
// Its variances are products of one factor per clue, its mean along the prediction a sum of one
// term per clue; both are learned online.
#pragma once

#include <array>
#include <cstdint>

#include "codec/core/vec.h"
#include "codec/progressive/residual_coder.h"

namespace vitrine {

// What is known about a split once the fine connectivity is: all positions relative to v~.
struct SplitSurroundings {
  static constexpr std::size_t kFeatures = 9;
  std::array<Vec3, kFeatures> features{};  // each turns into its negative when V1 and V2 swap
  Vec3 normal;                             // unit, or zero where there is none
  double scale = 1;                        // mean distance of the neighbours, lattice units, >= 0.5

  static constexpr std::size_t kKinds = 2;
  std::size_t kind = 0;  // 1 where both vertices have at least five neighbours besides each other

  // Clues to the size of the prediction's error, each in 0..kLevels-1.
  static constexpr std::size_t kClues = 13, kLevels = 24;
  std::array<std::uint8_t, kClues> clues{};
};

// Squared error of a predicted D in units of the scale.
struct SplitError {
  double all = 0, normal = 0;
};

class DisplacementModel {
 public:
  DisplacementModel();

  template <class Coder>
  Vec3i code(Coder& coder, const SplitSurroundings& s, Vec3i truth, SplitError& split_error) {
    const Vec3 linear = combine(s);
    const Spread spread = spread_of(s, linear);
    const Vec3 predicted = linear + spread.frame[0] * (spread.bias * s.scale);
    const Vec3i d = code_vector(coder, predicted, covariance(s, spread), truth);
    const Vec3 error = to_vec3(d) - predicted;
    const double inverse = 1 / (s.scale * s.scale);
    const double normal = dot(error, spread.frame[1]);
    split_error = {dot(error, error) * inverse, normal * normal * inverse};
    learn_spread(s, spread, error);
    learn_weights(s, to_vec3(d));
    return d;
  }

  static constexpr std::size_t kFeatures = SplitSurroundings::kFeatures;
  static constexpr std::size_t kKinds = SplitSurroundings::kKinds;
  static constexpr std::size_t kClues = SplitSurroundings::kClues;
  static constexpr std::size_t kLevels = SplitSurroundings::kLevels;
  using Weights = std::array<double, kFeatures>;

  // What one level of one clue says about the error.
  struct Evidence {
    std::array<double, 3> factor{};  // of the variances along, normal, across, in scale squared
    double bias = 0;                 // term of the mean along the prediction, in scale
    double seen = 0;                 // splits that it stands for
  };

  const Weights& tangential_weights(std::size_t kind) const {
    return part_[kind].tangential.weights;
  }
  const Weights& normal_weights(std::size_t kind) const { return part_[kind].normal.weights; }
  const auto& evidence() const { return evidence_; }
  const ResidualCoder& residuals() const { return coder_; }
  static constexpr double kPriorWeight = 60;  // how many splits a start of the evidence counts for

 private:
  Vec3 combine(const SplitSurroundings& s) const;

  struct Spread {
    std::array<Vec3, 3> frame;         // unit: along the prediction, normal, across
    std::array<double, 3> variance{};  // in its axes, in scale squared
    double bias = 0;                   // along the prediction, in scale
  };

  Spread spread_of(const SplitSurroundings& s, const Vec3& linear) const;
  // In lattice axes: xx, xy, xz, yy, yz, zz.
  static std::array<double, 6> covariance(const SplitSurroundings& s, const Spread& spread);
  void learn_spread(const SplitSurroundings& s, const Spread& spread, const Vec3& error);
  void learn_weights(const SplitSurroundings& s, const Vec3& d);

  template <class Coder>
  Vec3i code_vector(Coder& coder, const Vec3& mean, const std::array<double, 6>& c, Vec3i truth) {
    const auto& [xx, xy, xz, yy, yz, zz] = c;
    Vec3i d;
    d.x = coder_.code(coder, truth.x, mean.x, std::sqrt(xx));
    const double ex = (d.x - mean.x) / xx;
    const double yy_x = std::max(yy - xy * xy / xx, kGrain);
    const double yz_x = yz - xy * xz / xx;
    const double mean_y = mean.y + xy * ex;
    d.y = coder_.code(coder, truth.y, mean_y, std::sqrt(yy_x));
    const double ey = (d.y - mean_y) / yy_x;
    const double zz_xy = std::max(zz - xz * xz / xx - yz_x * yz_x / yy_x, kGrain);
    d.z = coder_.code(coder, truth.z, mean.z + xz * ex + yz_x * ey, std::sqrt(zz_xy));
    return d;
  }

  static constexpr double kGrain = 0.12;  // variance of rounding to the lattice, and a little

  // Recursive least squares of one part of D on the same part of the features.
  struct Regression {
    std::array<double, kFeatures> weights{};
    std::array<std::array<double, kFeatures>, kFeatures> matrix{};
    std::array<double, kFeatures> right_side{};

    void start(const double* prior);
    void solve();
  };

  struct Part {
    Regression tangential, normal;
    std::uint32_t learned = 0;
  };

  std::array<Part, kKinds> part_;
  std::array<std::array<Evidence, kLevels>, kClues> evidence_;
  ResidualCoder coder_;
};

}  // namespace vitrine
