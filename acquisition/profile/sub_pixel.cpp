// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/sub_pixel.h"

#include <algorithm>
#include <cmath>

namespace vitrine::acquisition {
namespace {

// Standard deviation of the filter (a Gaussian's derivative), as a multiple of the stripe's
// standard deviation. A wider filter resists speckle better. A narrower filter is less disturbed by
// albedo edges on the flank. A very wide filter approaches the centre of mass.
constexpr double kFilterWidth = 1.4;
constexpr int kMassSteps = 4;  // rounds in which the window is centred on the previous result

std::vector<double> kernel_of(const StripeOptions& options) {
  if (options.method == StripeMethod::kBlaisRioux) return {1, 1};
  const double s = options.width * kFilterWidth;
  std::vector<double> kernel(static_cast<std::size_t>(std::ceil(3 * s)));
  for (std::size_t k = 0; k < kernel.size(); ++k) {
    const double x = static_cast<double>(k + 1);
    kernel[k] = x * std::exp(-x * x / (2 * s * s));
  }
  return kernel;
}

}  // namespace

SubPixel::SubPixel(const StripeOptions& options)
    : method_(options.method),
      reach_(static_cast<int>(std::ceil(3 * options.width))),
      kernel_(kernel_of(options)) {}

std::optional<double> SubPixel::centre(std::span<const std::uint8_t> lit,
                                       std::span<const std::uint8_t> dark, int u) const {
  return method_ == StripeMethod::kCentreOfMass ? mass(lit, dark, u) : zero(lit, dark, u);
}

// Returns the position at which the filtered row changes from rising to falling, interpolated
// linearly between two pixels.
std::optional<double> SubPixel::zero(std::span<const std::uint8_t> lit,
                                     std::span<const std::uint8_t> dark, int u) const {
  const int margin = static_cast<int>(kernel_.size()), width = static_cast<int>(lit.size());
  const auto inside = [&](int at) { return at >= margin && at < width - margin; };
  const auto slope = [&](int at) {
    double sum = 0;
    const auto middle = static_cast<std::size_t>(at);
    for (std::size_t k = 1; k <= kernel_.size(); ++k)
      sum += kernel_[k - 1] *
             (lit[middle + k] - dark[middle + k] - lit[middle - k] + dark[middle - k]);
    return sum;
  };
  if (!inside(u)) return {};
  double here = slope(u);
  const int step = here > 0 ? 1 : -1;
  for (int at = u; std::abs(at + step - u) <= reach_ && inside(at + step); at += step) {
    const double there = slope(at + step);
    if ((there > 0) != (here > 0)) return at + step * here / (here - there);
    here = there;
  }
  return {};
}

std::optional<double> SubPixel::mass(std::span<const std::uint8_t> lit,
                                     std::span<const std::uint8_t> dark, double u) const {
  const int width = static_cast<int>(lit.size());
  for (int step = 0; step < kMassSteps; ++step) {
    const int middle = static_cast<int>(std::lround(u));
    if (middle < reach_ || middle >= width - reach_) return {};
    double sum = 0, moment = 0;
    for (int at = middle - reach_; at <= middle + reach_; ++at) {
      const auto i = static_cast<std::size_t>(at);
      const double level = lit[i] - dark[i];
      sum += level, moment += level * (at - middle);
    }
    if (!(sum > 0) || std::abs(moment) > sum * reach_) return {};
    u = middle + moment / sum;
  }
  return u;
}

}  // namespace vitrine::acquisition
