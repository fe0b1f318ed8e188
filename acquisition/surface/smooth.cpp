// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/smooth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace vitrine {
namespace {

// In points on either side: profiles, rows.
struct Reach {
  int profiles, rows;
};
constexpr std::array<Reach, 4> kWindows = {{{4, 6}, {3, 4}, {2, 2}, {1, 1}}};
constexpr int kTerms = 6;  // 1, x, y, x², xy, y²
// Calibrated noise is an average: it is more where the stripe is weak or the surface slants, and
// the motor's error adds to it.
constexpr double kAllowed = 1.5;  // times `noise`, rms of what is left
constexpr double kOwn = 3;        // times `noise`: how far a point may move

// The quadratics over a window of the grid, made orthonormal: a fit is one product a term.
class Basis {
 public:
  explicit Basis(Reach reach) : reach_(reach) {
    for (int x = -reach.profiles; x <= reach.profiles; ++x) {
      for (int y = -reach.rows; y <= reach.rows; ++y) {
        const double p = x, q = y;
        terms_.push_back({1, p, q, p * p, p * q, q * q});
      }
    }
    // Gram-Schmidt.
    for (std::size_t k = 0; k < kTerms; ++k) {
      for (std::size_t j = 0; j < k; ++j)
        subtract(k, j, product(k, j));
      const double norm = std::sqrt(product(k, k));
      for (auto& t : terms_)
        t[k] /= norm;
    }
  }

  Reach reach() const { return reach_; }

  // The quadratic at the middle of `values`, if it leaves no more than `rms` of them.
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
  std::vector<std::array<double, kTerms>> terms_;  // at each place of the window
};

// rho over profile and row, NaN where there is no point.
class Grid {
 public:
  Grid(const std::vector<Profile>& profiles, int step) : step_(step) {
    low_ = std::numeric_limits<int>::max();
    int high = std::numeric_limits<int>::min();
    for (const Profile& profile : profiles) {
      if (profile.points.empty()) continue;
      low_ = std::min(low_, profile.points.front().row);
      high = std::max(high, profile.points.back().row);
    }
    rows_ = high < low_ ? 0 : (high - low_) / step_ + 1;
    profiles_ = static_cast<int>(profiles.size());
    rho_.assign(static_cast<std::size_t>(rows_) * profiles.size(),
                std::numeric_limits<double>::quiet_NaN());
    for (int k = 0; k < profiles_; ++k) {
      for (const ProfilePoint& point : profiles[static_cast<std::size_t>(k)].points)
        rho_[index(k, row(point))] = point.at.rho;
    }
  }

  int row(const ProfilePoint& point) const { return (point.row - low_) / step_; }

  // Less the middle's. False where the window is not complete.
  bool window(int profile, int row, Reach reach, std::vector<double>& values) const {
    if (row < reach.rows || row + reach.rows >= rows_ || 2 * reach.profiles >= profiles_)
      return false;
    const double middle = rho_[index(profile, row)];
    values.clear();
    for (int x = -reach.profiles; x <= reach.profiles; ++x) {
      const int k = (profile + x + profiles_) % profiles_;
      const double* from = &rho_[index(k, row - reach.rows)];
      for (int y = 0; y <= 2 * reach.rows; ++y) {
        const double value = from[y] - middle;
        if (std::isnan(value)) return false;
        values.push_back(value);
      }
    }
    return true;
  }

 private:
  std::size_t index(int profile, int row) const {
    return static_cast<std::size_t>(profile) * static_cast<std::size_t>(rows_) +
           static_cast<std::size_t>(row);
  }

  int step_, low_ = 0, rows_ = 0, profiles_ = 0;
  std::vector<double> rho_;
};

}  // namespace

std::uint64_t smooth(std::vector<Profile>& profiles, double noise, const Spacing& spacing) {
  if (!(noise > 0)) return 0;
  const Grid grid(profiles, spacing.rows);
  std::vector<Basis> bases(kWindows.begin(), kWindows.end());
  std::vector<double> values;
  std::uint64_t moved = 0;
  for (std::size_t k = 0; k < profiles.size(); ++k) {
    for (ProfilePoint& point : profiles[k].points) {
      for (const Basis& basis : bases) {
        if (!grid.window(static_cast<int>(k), grid.row(point), basis.reach(), values)) continue;
        const auto shift = basis.middle(values, kAllowed * noise);
        if (!shift || std::abs(*shift) > kOwn * noise) continue;
        point.at.rho += *shift, ++moved;
        break;
      }
    }
  }
  return moved;
}

}  // namespace vitrine
