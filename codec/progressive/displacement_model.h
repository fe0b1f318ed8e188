// SPDX-License-Identifier: Apache-2.0
// D = V1 - V2 of a vertex split: predicted as a combination of features of the fine one-rings whose
// weights are learned online (recursive least squares), its error modelled as a Gaussian in the
// frame (predicted direction, normal, across) and coded axis by axis, each conditional on the last.
#pragma once

#include <array>
#include <cstdint>

#include "codec/core/vec.h"
#include "codec/progressive/residual_coder.h"

namespace vitrine {

// What is known about a split once the fine connectivity is: all positions relative to v~.
struct SplitSurroundings {
  static constexpr std::size_t kFeatures = 7;
  std::array<Vec3, kFeatures> features{};  // each turns into its negative when V1 and V2 swap
  Vec3 normal;                             // unit, or zero where there is none
  double scale = 1;                        // mean distance of the neighbours, lattice units, >= 0.5
  int context = 0;                         // 0..kContexts-1: how far the features agree
  static constexpr int kContexts = 84;
};

class DisplacementModel {
 public:
  DisplacementModel();

  template <class Coder>
  Vec3i code(Coder& coder, const SplitSurroundings& s, Vec3i truth, double& relative_error) {
    const Vec3 predicted = predict(s);
    Spread spread = spread_of(s, predicted);
    const Vec3i d = code_vector(coder, predicted, spread.covariance, truth);
    const Vec3 error = to_vec3(d) - predicted;
    learn(s, spread, error, to_vec3(d));
    relative_error = dot(error, error) / (s.scale * s.scale);
    return d;
  }

  static constexpr std::size_t kFeatures = SplitSurroundings::kFeatures;
  using Weights = std::array<double, kFeatures>;
  const Weights& tangential_weights() const { return tangential_.weights; }
  const Weights& normal_weights() const { return normal_.weights; }
  const auto& energy() const { return energy_; }
  const auto& energy_weight() const { return weight_; }
  const ResidualCoder& residuals() const { return coder_; }

 private:
  Vec3 predict(const SplitSurroundings& s) const;

  struct Spread {
    std::array<Vec3, 3> frame;           // unit: along the prediction, normal, across
    std::array<double, 6> covariance{};  // xx, xy, xz, yy, yz, zz
  };

  Spread spread_of(const SplitSurroundings& s, const Vec3& predicted) const;
  void learn(const SplitSurroundings& s, const Spread& spread, const Vec3& error, const Vec3& d);

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

  Regression tangential_, normal_;
  std::uint32_t learned_ = 0;
  std::array<std::array<double, 3>, SplitSurroundings::kContexts> energy_{};  // of error / scale
  std::array<std::array<double, 3>, SplitSurroundings::kContexts> weight_{};
  ResidualCoder coder_;
};

}  // namespace vitrine
