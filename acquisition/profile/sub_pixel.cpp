// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/sub_pixel.h"

#include <algorithm>
#include <cmath>

namespace vitrine {
namespace {

// Standard deviation of the derivative's Gaussian, in those of the stripe. Against speckle wider is
// better; against albedo edges on the flank narrower. Very wide it becomes the centre of mass.
constexpr double kFilterWidth = 1.4;
constexpr int kMassSteps = 4;  // the window follows the centre it finds

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

// Where the filtered row turns from rising to falling, linear between two pixels.
std::optional<double> SubPixel::zero(std::span<const std::uint8_t> lit,
                                     std::span<const std::uint8_t> dark, int u) const {
  const int margin = static_cast<int>(kernel_.size()), width = static_cast<int>(lit.size());
  const auto inside = [&](int at) { return at >= margin && at < width - margin; };
  const auto slope = [&](int at) {
    double sum = 0;
    for (int k = 1; k <= margin; ++k) {
      const std::size_t right = static_cast<std::size_t>(at + k),
                        left = static_cast<std::size_t>(at - k);
      sum += kernel_[static_cast<std::size_t>(k - 1)] *
             (lit[right] - dark[right] - lit[left] + dark[left]);
    }
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
  for (int i = 0; i < kMassSteps; ++i) {
    const int middle = static_cast<int>(std::lround(u));
    if (middle < reach_ || middle >= width - reach_) return {};
    double sum = 0, moment = 0;
    for (int k = -reach_; k <= reach_; ++k) {
      const std::size_t at = static_cast<std::size_t>(middle + k);
      const double level = lit[at] - dark[at];
      sum += level, moment += level * k;
    }
    if (!(sum > 0) || std::abs(moment) > sum * reach_) return {};
    u = middle + moment / sum;
  }
  return u;
}

}  // namespace vitrine
