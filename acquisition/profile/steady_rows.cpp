// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/stripe_steps.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "acquisition/profile/line_fit.h"

namespace vitrine::acquisition {
namespace {

// Factor that corrects the noise estimated from the median. Speckle moves a few rows far; the
// median ignores these rows, so the estimate is too small.
constexpr double kTails = 1.4;

// Estimates the standard deviation of one row's position. The median of the third differences |a -
// 3 b + 3 c - d| is .6745 sqrt(20) times that standard deviation. A bend alone does not increase
// third differences.
double noise_of(const std::vector<StripePoint>& stripe) {
  std::vector<double> thirds;
  for (std::size_t i = 3; i < stripe.size(); ++i) {
    if (stripe[i].row - stripe[i - 3].row == 3)
      thirds.push_back(
          std::abs(stripe[i - 3].u - 3 * stripe[i - 2].u + 3 * stripe[i - 1].u - stripe[i].u));
  }
  if (thirds.empty()) return 0;
  const auto middle = thirds.begin() + static_cast<std::ptrdiff_t>(thirds.size() / 2);
  std::nth_element(thirds.begin(), middle, thirds.end());
  return *middle / (.6745 * std::sqrt(20));
}

std::optional<double> on_line(const std::vector<StripePoint>& stripe, std::size_t i, int reach,
                              double noise) {
  std::size_t from = i, to = i + 1;
  while (from > 0 && stripe[i].row - stripe[from - 1].row <= reach)
    --from;
  while (to < stripe.size() && stripe[to].row - stripe[i].row <= reach)
    ++to;
  LineFit line;
  for (std::size_t k = from; k < to; ++k)
    line.add(stripe[k].row - stripe[i].row, stripe[k].u);
  if (!line.is_within(noise)) return {};
  return line.at(0);
}

}  // namespace

void steady(std::vector<StripePoint>& stripe, int reach) {
  const double noise = kTails * noise_of(stripe);
  std::vector<double> u(stripe.size());
  for (std::size_t i = 0; i < stripe.size(); ++i) {
    std::optional<double> line;
    for (int rows = reach; rows > 0 && !line; rows /= 2)
      line = on_line(stripe, i, rows, noise);
    u[i] = line.value_or(stripe[i].u);
  }
  for (std::size_t i = 0; i < stripe.size(); ++i)
    stripe[i].u = u[i];
}

}  // namespace vitrine::acquisition
