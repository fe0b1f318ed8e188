// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace vitrine::acquisition {
namespace {

// Half of a window's size, in steps and in rows, without the centre.
struct Reach {
  int steps, rows;
};
constexpr std::array<Reach, 4> kWindows = {{{4, 6}, {3, 4}, {2, 2}, {1, 1}}};
constexpr int kTerms = 6;  // the terms are 1, x, y, x², xy, y²
// Limits, as multiples of `noise`. They exceed 1, because the calibrated noise is an average. The
// noise is larger where the stripe is weak or the surface is oblique, and the motor adds its error.
constexpr double kAllowed = 1.5;  // largest rms of the residuals, in multiples of `noise`
constexpr double kOwn = 3;        // largest motion of a point, in multiples of `noise`

// Orthonormal quadratic polynomials over a window of the grid. They reduce a fit to one dot product
// per term.
class Basis {
 public:
  explicit Basis(Reach reach) : reach_(reach) {
    for (int x = -reach.steps; x <= reach.steps; ++x) {
      for (int y = -reach.rows; y <= reach.rows; ++y) {
        const double p = x, q = y;
        terms_.push_back({1, p, q, p * p, p * q, q * q});
      }
    }
    // Orthonormalises the terms by the Gram-Schmidt method.
    for (std::size_t k = 0; k < kTerms; ++k) {
      for (std::size_t j = 0; j < k; ++j)
        subtract(k, j, product(k, j));
      const double norm = std::sqrt(product(k, k));
      for (auto& t : terms_)
        t[k] /= norm;
    }
  }

  Reach reach() const { return reach_; }

  // Fits a quadratic to `values` and returns its value at the centre. Returns nullopt if the rms of
  // the residuals exceeds `rms`.
  std::optional<double> middle(const std::vector<double>& values, double rms) const {
    std::array<double, kTerms> c{};
    double squares = 0, fitted = 0, at_middle = 0;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      squares += values[i] * values[i];
      for (std::size_t k = 0; k < kTerms; ++k)
        c[k] += terms_[i][k] * values[i];
    }
    for (std::size_t k = 0; k < kTerms; ++k)
      fitted += c[k] * c[k], at_middle += c[k] * terms_[terms_.size() / 2][k];
    const double freedom = static_cast<double>(terms_.size() - kTerms);
    if (squares - fitted > rms * rms * freedom) return {};
    return at_middle;
  }

 private:
  double product(std::size_t k, std::size_t j) const {
    double sum = 0;
    for (const auto& t : terms_)
      sum += t[k] * t[j];
    return sum;
  }
  void subtract(std::size_t k, std::size_t j, double share) {
    for (auto& t : terms_)
      t[k] -= share * t[j];
  }

  Reach reach_;
  std::vector<std::array<double, kTerms>> terms_;  // values of the terms in the window
};

// The values of rho by step and row, in one layer for each strand of a step. A position without a
// point is NaN.
class Grid {
 public:
  Grid(const std::vector<Profile>& strands, const std::vector<std::size_t>& steps, int step)
      : step_(step), count_(static_cast<int>(steps.size()) - 1) {
    low_ = std::numeric_limits<int>::max();
    int high = std::numeric_limits<int>::min();
    for (const Profile& strand : strands) {
      if (strand.points.empty()) continue;
      low_ = std::min(low_, strand.points.front().row);
      high = std::max(high, strand.points.back().row);
    }
    rows_ = high < low_ ? 0 : (high - low_) / step_ + 1;
    for (int s = 0; s < count_; ++s)
      put(s, std::span(strands).subspan(steps[s], steps[s + 1] - steps[s]));
  }

  int row(const ProfilePoint& point) const { return (point.row - low_) / step_; }

  // Copies a window's values, relative to the value at its centre, to `values`. Returns false if
  // the window is incomplete.
  bool window(std::size_t layer, int step, int row, Reach reach,
              std::vector<double>& values) const {
    if (row < reach.rows || row + reach.rows >= rows_ || 2 * reach.steps >= count_) return false;
    const double middle = layers_[layer][index(step, row)];
    values.clear();
    for (int x = -reach.steps; x <= reach.steps; ++x) {
      const std::size_t from = index((step + x + count_) % count_, row - reach.rows);
      for (std::size_t at = from; at <= from + 2 * static_cast<std::size_t>(reach.rows); ++at) {
        const double value = nearest(at, middle);
        if (std::isnan(value)) return false;
        values.push_back(value);
      }
    }
    return true;
  }

 private:
  void put(int step, std::span<const Profile> strands) {
    for (std::size_t layer = 0; layer < strands.size(); ++layer) {
      if (layer == layers_.size())
        layers_.emplace_back(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(count_),
                             std::numeric_limits<double>::quiet_NaN());
      for (const ProfilePoint& point : strands[layer].points)
        layers_[layer][index(step, row(point))] = point.at.rho;
    }
  }

  double nearest(std::size_t at, double middle) const {
    double best = layers_[0][at] - middle;
    for (std::size_t layer = 1; layer < layers_.size(); ++layer) {
      const double value = layers_[layer][at] - middle;
      if (std::isnan(best) || std::abs(value) < std::abs(best)) best = value;
    }
    return best;
  }

  std::size_t index(int step, int row) const {
    return static_cast<std::size_t>(step) * static_cast<std::size_t>(rows_) +
           static_cast<std::size_t>(row);
  }

  int step_, low_ = 0, rows_ = 0, count_;
  std::vector<std::vector<double>> layers_;
};

}  // namespace

std::uint64_t smooth(std::vector<Profile>& strands, double noise, const Spacing& spacing) {
  if (!(noise > 0)) return 0;
  const std::vector<std::size_t> steps = steps_of(strands);
  const Grid grid(strands, steps, spacing.rows);
  const std::vector<Basis> bases(kWindows.begin(), kWindows.end());
  std::vector<double> values;
  std::uint64_t moved = 0;
  const auto smooth_strand = [&](std::size_t step, std::size_t layer) {
    for (ProfilePoint& point : strands[steps[step] + layer].points) {
      for (const Basis& basis : bases) {
        if (!grid.window(layer, static_cast<int>(step), grid.row(point), basis.reach(), values))
          continue;
        const auto shift = basis.middle(values, kAllowed * noise);
        if (!shift || std::abs(*shift) > kOwn * noise) continue;
        point.at.rho += *shift, ++moved;
        break;
      }
    }
  };
  for (std::size_t step = 0; step + 1 < steps.size(); ++step) {
    for (std::size_t layer = 0; steps[step] + layer < steps[step + 1]; ++layer)
      smooth_strand(step, layer);
  }
  return moved;
}

}  // namespace vitrine::acquisition
