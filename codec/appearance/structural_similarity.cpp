// SPDX-License-Identifier: Apache-2.0
#include "codec/appearance/structural_similarity.h"

#include <array>
#include <cmath>

#include "codec/appearance/backdrop.h"

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kWindow = 11;  // width and height in pixels
constexpr std::size_t kCentre = kWindow / 2;
constexpr double kDeviation = 1.5;  // standard deviation of the weights, in pixels
constexpr double kC1 = (0.01 * 255) * (0.01 * 255), kC2 = (0.03 * 255) * (0.03 * 255);

// One value per pixel, rows from top to bottom.
struct Plane {
  std::size_t width, height;
  std::vector<double> values;
};

Plane luma(const Picture& picture) {
  Plane plane{picture.width, picture.height, {}};
  plane.values.reserve(plane.width * plane.height);
  for (std::size_t at = 0; at < picture.pixels.size(); at += 4) {
    const std::uint8_t* pixel = &picture.pixels[at];
    plane.values.push_back(0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2]);
  }
  return plane;
}

Plane product(const Plane& a, const Plane& b) {
  Plane plane = a;
  for (std::size_t i = 0; i < plane.values.size(); ++i)
    plane.values[i] *= b.values[i];
  return plane;
}

// Returns the weights along one axis of the window. The weight of a pixel is the product of the
// weights of its row and its column.
std::array<double, kWindow> gaussian() {
  std::array<double, kWindow> weights;
  double sum = 0;
  for (std::size_t i = 0; i < kWindow; ++i) {
    const double x = (static_cast<double>(i) - static_cast<double>(kCentre)) / kDeviation;
    sum += weights[i] = std::exp(-x * x / 2);
  }
  for (double& weight : weights)
    weight /= sum;
  return weights;
}

// Returns a plane of width x height values. Each value is the weighted sum of `kWindow` values of
// `plane` that are `stride` elements apart.
Plane weighted_sums(const Plane& plane, std::size_t width, std::size_t height, std::size_t stride) {
  static const auto weights = gaussian();
  Plane sums{width, height, std::vector<double>(width * height)};
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t i = 0; i < kWindow; ++i) {
      const double* from = &plane.values[y * plane.width + i * stride];
      double* to = &sums.values[y * width];
      for (std::size_t x = 0; x < width; ++x)
        to[x] += weights[i] * from[x];
    }
  }
  return sums;
}

// Returns the weighted mean of each window that lies inside the plane.
Plane window_means(const Plane& plane) {
  const std::size_t width = plane.width - (kWindow - 1), height = plane.height - (kWindow - 1);
  const Plane rows = weighted_sums(plane, width, plane.height, 1);
  return weighted_sums(rows, width, height, width);
}

// The window means of two pictures x and y, and of the products x * x, y * y and x * y.
struct Moments {
  Plane x, y, xx, yy, xy;

  // Returns the SSIM index of one window ([WBSS04] eq. 13).
  double similarity(std::size_t window) const {
    const double mx = x.values[window], my = y.values[window];
    const double variances = (xx.values[window] - mx * mx) + (yy.values[window] - my * my);
    const double covariance = xy.values[window] - mx * my;
    return (2 * mx * my + kC1) * (2 * covariance + kC2) /
           ((mx * mx + my * my + kC1) * (variances + kC2));
  }
};

Moments moments_of(const Plane& x, const Plane& y) {
  return {window_means(x), window_means(y), window_means(product(x, x)),
          window_means(product(y, y)), window_means(product(x, y))};
}

}  // namespace

std::optional<double> structural_similarity(const Picture& a, const Picture& b) {
  if (a.width < kWindow || a.height < kWindow) return std::nullopt;
  const Moments moments = moments_of(luma(a), luma(b));
  double sum = 0;
  std::size_t windows = 0;
  for (std::size_t y = 0; y < moments.x.height; ++y) {
    for (std::size_t x = 0; x < moments.x.width; ++x) {
      if (!is_covered(a, b, (y + kCentre) * a.width + x + kCentre)) continue;
      sum += moments.similarity(y * moments.x.width + x);
      ++windows;
    }
  }
  return windows == 0 ? std::nullopt : std::optional(sum / static_cast<double>(windows));
}

}  // namespace vitrine::inline codec
