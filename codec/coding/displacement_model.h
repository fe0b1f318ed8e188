// SPDX-License-Identifier: Apache-2.0
// Codes the difference D = V1 - V2 of the positions of a split's two vertices. The prediction of D
// is a weighted sum of features of the fine one-rings. The weights are learned online by recursive
// least squares.
//
// The prediction error is modelled as a Gaussian in a frame of three axes: the predicted direction,
// the surface normal, and the direction perpendicular to both. The components x, y and z of D are
// coded in turn, each conditional on the previous ones. The variance along an axis is a product
// with one factor per clue (SplitSurroundings::Clue). The mean error along the predicted direction
// is a sum with one term per clue. The factors and terms are learned online.
#pragma once

#include <array>
#include <cstdint>

#include "codec/coding/residual_coder.h"
#include "codec/core/double2.h"
#include "codec/core/vec.h"

namespace vitrine::inline codec {

// Features of the mesh around a split, computed after pass 1 (layer_pass.h). All positions are
// relative to the merged vertex, which is the vertex before its split.
struct SplitSurroundings {
  static constexpr std::size_t kFeatures = 9;
  std::array<Vec3, kFeatures> features{};  // each changes sign if V1 and V2 are swapped
  Vec3 normal;                             // unit normal of the surface, or zero if undefined
  double scale = 1;                        // mean distance of the neighbours, in cells, >= 0.5

  static constexpr std::size_t kKinds = 2;
  // 1 if each of the split's two vertices has at least five neighbours besides the other one; else
  // 0.
  std::size_t kind = 0;

  // Clues to the size of the prediction error. Each clue has an integer value in [0, kLevels - 1].
  enum Clue : std::size_t {
    kRingSizes,
    kScale,
    kParallelogram,  // length of the parallelogram prediction, relative to `scale`
    // Mean squared distance of the neighbours from the tangent plane, which goes through the merged
    // vertex and is perpendicular to `normal`, relative to scale^2.
    kHeight,
    kDistance,  // variance of the neighbours' distances from the merged vertex, relative to scale^2
    kSettled,   // share of the neighbours that have their final positions
    kChord,     // distance between the two cut vertices, relative to `scale`
    kSlant,     // cosine of the angle between the chord and the difference of the arcs' means
    kNeighbourError,
    kNeighbourNormalError,
    // this clue and the next two: the distance between two predictions of D
    kNeighboursFromLaplacian,
    kArcsFromLaplacian,
    kParallelogramsFromLaplacian,
    kClues
  };
  static constexpr std::size_t kLevels = 24;
  std::array<std::uint8_t, kClues> clues;
};

// Squared error of a predicted D, relative to scale^2: of the whole vector, and along the normal.
struct SplitError {
  double all = 0, normal = 0;
};

class DisplacementModel {
 public:
  DisplacementModel();

  template <class Coder>
  Vec3i code(Coder& coder, const SplitSurroundings& s, Vec3i truth, SplitError& split_error) {
    const FeatureColumns columns = columns_of(s);
    const Vec3 linear = combine(s, columns);
    const ErrorGaussian gaussian = gaussian_of(s, linear);
    const Vec3 predicted = linear + gaussian.frame[0] * (gaussian.bias * s.scale);
    const Vec3i d = code_vector(coder, predicted, covariance(s, gaussian), truth);
    const Vec3 error = to_vec3(d) - predicted;
    const double inverse = 1 / (s.scale * s.scale);
    const double normal = dot(error, gaussian.frame[1]);
    split_error = {dot(error, error) * inverse, normal * normal * inverse};
    learn_gaussian(s, gaussian, error);
    learn_weights(s, columns, to_vec3(d));
    return d;
  }

  static constexpr std::size_t kFeatures = SplitSurroundings::kFeatures;
  static constexpr std::size_t kKinds = SplitSurroundings::kKinds;
  static constexpr std::size_t kClues = SplitSurroundings::kClues;
  static constexpr std::size_t kLevels = SplitSurroundings::kLevels;
  using Weights = std::array<double, kFeatures>;

  // The effect of one value of one clue on the Gaussian error model.
  struct Evidence {
    std::array<double, 3> factor{};  // factors for the variances along the three axes
    double bias = 0;  // part of the mean error along the prediction, in units of scale
    double seen = 0;  // number of splits learned from, plus kPriorWeight
  };

  const Weights& tangential_weights(std::size_t kind) const { return kinds_[kind].tangential; }
  const Weights& normal_weights(std::size_t kind) const { return kinds_[kind].normal; }
  const auto& evidence() const { return evidence_; }
  const ResidualCoder& residuals() const { return coder_; }
  static constexpr double kPriorWeight = 60;  // the start values count like this number of splits

 private:
  // Rows have an even size, so that they can be processed two elements at a time.
  static constexpr std::size_t kRow = kFeatures + kFeatures % 2;

  // The features as one array per coordinate, and their dot products with the normal.
  struct FeatureColumns {
    std::array<double, kRow> x, y, z, normal;
  };
  static FeatureColumns columns_of(const SplitSurroundings& s);

  Vec3 combine(const SplitSurroundings& s, const FeatureColumns& columns) const;

  struct ErrorGaussian {
    // unit vectors: along the prediction, along the normal, and perpendicular to both
    std::array<Vec3, 3> frame;
    std::array<double, 3> variance{};  // along the axes of the frame, in units of scale squared
    double bias = 0;                   // mean error along the prediction, in units of scale
  };

  ErrorGaussian gaussian_of(const SplitSurroundings& s, const Vec3& linear) const;
  // Returns the covariance matrix in lattice coordinates, in the order xx, xy, xz, yy, yz, zz.
  static std::array<double, 6> covariance(const SplitSurroundings& s,
                                          const ErrorGaussian& gaussian);
  void learn_gaussian(const SplitSurroundings& s, const ErrorGaussian& gaussian, const Vec3& error);
  void learn_weights(const SplitSurroundings& s, const FeatureColumns& columns, const Vec3& d);

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

  static constexpr double kGrain = 0.12;  // variance from rounding to the lattice, plus a margin

  // Recursive least squares for two parts of D: the tangential and the normal part. The inputs are
  // the tangential and normal parts of the features. The first number of each Double2 is for the
  // tangential part, the second for the normal part. Only matrix[a][b] with b <= a is used.
  struct Regression {
    Weights tangential{}, normal{};
    std::array<std::array<Double2, kRow>, kFeatures> matrix{};
    std::array<Double2, kFeatures> right_side{};
    std::uint32_t learned = 0;

    void start(const double* tangential_prior, const double* normal_prior);
    void solve();
  };

  std::array<Regression, kKinds> kinds_;
  std::array<std::array<Evidence, kLevels>, kClues> evidence_;
  ResidualCoder coder_;
};

}  // namespace vitrine::inline codec
