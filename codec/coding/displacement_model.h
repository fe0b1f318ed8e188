// SPDX-License-Identifier: Apache-2.0
// Codes the difference D = V1 - V2 of the positions of a split's two vertices. D is predicted as a
// weighted sum of features of the fine one-rings; the weights are learned online (recursive least
// squares).
//
// The error of the prediction is modelled as a Gaussian in a frame of three axes: the predicted
// direction, the normal, and the direction across both. The components x, y and z of D are coded in
// turn, each conditional on the previous ones. The variance along each axis of the frame is a
// product with one factor per clue (SplitSurroundings::Clue). The mean along the prediction is a
// sum with one term per clue. Factors and terms are learned online.
#pragma once

#include <array>
#include <cstdint>

#include "codec/coding/residual_coder.h"
#include "codec/core/vec.h"

namespace vitrine::inline codec {

// The surroundings of a split in the mesh after pass 1 (layer_pass.h). All positions are relative
// to v~, the position of the vertex before its split.
struct SplitSurroundings {
  static constexpr std::size_t kFeatures = 9;
  std::array<Vec3, kFeatures> features{};  // each changes its sign if V1 and V2 are swapped
  Vec3 normal;                             // unit vector, or zero if there is no normal
  double scale = 1;  // mean distance of the neighbours from v~, in cells, >= 0.5

  static constexpr std::size_t kKinds = 2;
  // 1 if both vertices have at least five neighbours, not counting each other; else 0.
  std::size_t kind = 0;

  // Clues that indicate how large the error of the prediction is. Each clue has an integer value in
  // [0, kLevels - 1].
  enum Clue : std::size_t {
    kRingSizes,
    kScale,
    kParallelogram,  // length of the prediction by parallelograms, relative to `scale`
    // Mean squared height of the neighbours over the plane through v~ that is perpendicular to
    // `normal`, relative to scale^2.
    kHeight,
    kDistance,  // variance of the neighbours' distances from v~, relative to scale^2
    kSettled,   // share of the neighbours whose positions are final
    kChord,     // distance between the two cut vertices (the chord), relative to `scale`
    kSlant,     // cosine of the angle between the chord and the difference of the arcs' means
    kNeighbourError,
    kNeighbourNormalError,
    kNeighboursFromLaplacian,  // this clue and the next two: distance between two predictions of D
    kArcsFromLaplacian,
    kParallelogramsFromLaplacian,
    kClues
  };
  static constexpr std::size_t kLevels = 24;
  std::array<std::uint8_t, kClues> clues{};
};

// Squared error of a predicted D, divided by the squared scale.
struct SplitError {
  double all = 0, normal = 0;
};

class DisplacementModel {
 public:
  DisplacementModel();

  template <class Coder>
  Vec3i code(Coder& coder, const SplitSurroundings& s, Vec3i truth, SplitError& split_error) {
    const Vec3 linear = combine(s);
    const ErrorGaussian gaussian = gaussian_of(s, linear);
    const Vec3 predicted = linear + gaussian.frame[0] * (gaussian.bias * s.scale);
    const Vec3i d = code_vector(coder, predicted, covariance(s, gaussian), truth);
    const Vec3 error = to_vec3(d) - predicted;
    const double inverse = 1 / (s.scale * s.scale);
    const double normal = dot(error, gaussian.frame[1]);
    split_error = {dot(error, error) * inverse, normal * normal * inverse};
    learn_gaussian(s, gaussian, error);
    learn_weights(s, to_vec3(d));
    return d;
  }

  static constexpr std::size_t kFeatures = SplitSurroundings::kFeatures;
  static constexpr std::size_t kKinds = SplitSurroundings::kKinds;
  static constexpr std::size_t kClues = SplitSurroundings::kClues;
  static constexpr std::size_t kLevels = SplitSurroundings::kLevels;
  using Weights = std::array<double, kFeatures>;

  // The contribution of one value of one clue to the model of the error.
  struct Evidence {
    std::array<double, 3> factor{};  // factors of the variances along the three axes of the frame
    double bias = 0;                 // term of the mean along the prediction, in units of scale
    double seen = 0;  // number of splits from which it was learned, including the start weight
  };

  const Weights& tangential_weights(std::size_t kind) const {
    return kinds_[kind].tangential.weights;
  }
  const Weights& normal_weights(std::size_t kind) const { return kinds_[kind].normal.weights; }
  const auto& evidence() const { return evidence_; }
  const ResidualCoder& residuals() const { return coder_; }
  static constexpr double kPriorWeight = 60;  // weight of the evidence's start values, in splits

 private:
  Vec3 combine(const SplitSurroundings& s) const;

  struct ErrorGaussian {
    std::array<Vec3, 3> frame;         // unit vectors: along the prediction, normal, across
    std::array<double, 3> variance{};  // along the axes of the frame, in units of scale squared
    double bias = 0;                   // mean along the prediction, in units of scale
  };

  ErrorGaussian gaussian_of(const SplitSurroundings& s, const Vec3& linear) const;
  // Returns the covariance matrix in lattice axes: xx, xy, xz, yy, yz, zz.
  static std::array<double, 6> covariance(const SplitSurroundings& s,
                                          const ErrorGaussian& gaussian);
  void learn_gaussian(const SplitSurroundings& s, const ErrorGaussian& gaussian, const Vec3& error);
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

  static constexpr double kGrain = 0.12;  // variance of rounding to the lattice, plus a margin

  // Recursive least squares for the normal part or the tangential part of D, which is predicted
  // from the same part of the features.
  struct Regression {
    std::array<double, kFeatures> weights{};
    std::array<std::array<double, kFeatures>, kFeatures> matrix{};
    std::array<double, kFeatures> right_side{};

    void start(const double* prior);
    void solve();
  };

  struct KindModel {
    Regression tangential, normal;
    std::uint32_t learned = 0;
  };

  std::array<KindModel, kKinds> kinds_;
  std::array<std::array<Evidence, kLevels>, kClues> evidence_;
  ResidualCoder coder_;
};

}  // namespace vitrine::inline codec
