// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/stripe_noise.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

namespace vitrine::acquisition {
namespace {

constexpr std::size_t kLeastDifferences = 20;

}  // namespace

double stripe_noise(std::span<const LaserPoint> stripe, const PlaneMap& map) {
  std::map<int, std::vector<cv::Point2f>> poses;
  for (const LaserPoint& p : stripe) {
    const auto at = map.at(p.in_image.u, p.in_image.v);
    if (at) poses[p.pose].emplace_back(static_cast<float>(at->x), static_cast<float>(at->y));
  }
  std::vector<double> deviations;
  for (const auto& [pose, points] : poses) {
    if (points.size() < kLeastDifferences) continue;
    cv::Vec4f line;  // direction of the line, then a point on it
    cv::fitLine(points, line, cv::DIST_L1, 0, 0.001, 0.001);
    if (std::abs(line[1]) < 0.1f) continue;  // along a nearly horizontal line, x is not determined
    for (const cv::Point2f& p : points)
      deviations.push_back(std::abs(p.x - line[2] - (p.y - line[3]) * line[0] / line[1]));
  }
  if (deviations.empty()) return 0;
  const auto middle = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2);
  std::ranges::nth_element(deviations, middle);
  return 1.4826 * *middle;
}

}  // namespace vitrine::acquisition
