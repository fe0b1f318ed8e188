// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/sheet_map.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace vitrine::acquisition {
namespace {

constexpr int kGrid = 40;  // intervals along each side of the grid

std::vector<cv::Point2f> hull_of(std::span<const LaserPoint> stripe, const SheetArea& area) {
  std::vector<cv::Point2f> points, seen, hull;
  for (const LaserPoint& p : stripe)
    points.emplace_back(static_cast<float>(p.in_image.u), static_cast<float>(p.in_image.v));
  cv::convexHull(points, seen);
  points.clear();
  const float margin = static_cast<float>(area.margin);
  for (const cv::Point2f& p : seen) {
    for (const cv::Point2f& corner : {cv::Point2f(-1, -1), {1, -1}, {-1, 1}, {1, 1}}) {
      const cv::Point2f at = p + margin * corner;
      points.emplace_back(std::clamp(at.x, 0.0f, static_cast<float>(area.width - 1)),
                          std::clamp(at.y, 0.0f, static_cast<float>(area.height - 1)));
    }
  }
  cv::convexHull(points, hull);
  return hull;
}

}  // namespace

std::vector<Correspondence> sheet_points(std::span<const LaserPoint> stripe,
                                         const CameraModel& camera, const LightPlane& plane,
                                         const SheetArea& area) {
  const std::vector<cv::Point2f> hull = hull_of(stripe, area);
  const cv::Rect2f box = [&] {
    const auto [left, right] = std::ranges::minmax(hull, {}, &cv::Point2f::x);
    const auto [top, bottom] = std::ranges::minmax(hull, {}, &cv::Point2f::y);
    return cv::Rect2f(left.x, top.y, right.x - left.x, bottom.y - top.y);
  }();
  std::vector<ImagePoint> pixels;
  pixels.reserve(hull.size() + (kGrid + 1) * (kGrid + 1));
  for (const cv::Point2f& corner : hull)
    pixels.push_back({corner.x, corner.y});
  for (int i = 0; i <= kGrid; ++i) {
    for (int j = 0; j <= kGrid; ++j) {
      const cv::Point2f at(box.x + box.width * static_cast<float>(i) / kGrid,
                           box.y + box.height * static_cast<float>(j) / kGrid);
      if (cv::pointPolygonTest(hull, at, false) >= 0) pixels.push_back({at.x, at.y});
    }
  }
  std::vector<Correspondence> points;
  const std::vector<cv::Vec3d> directions = rays(camera, pixels);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const cv::Vec3d at = plane.within(meet(directions[i], plane.origin, plane.normal));
    if (std::isfinite(at[0])) points.push_back({pixels[i].u, pixels[i].v, {at[0], at[1]}, 0});
  }
  return points;
}

}  // namespace vitrine::acquisition
