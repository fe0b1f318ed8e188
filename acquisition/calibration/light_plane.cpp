// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/light_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <random>

namespace vitrine::acquisition {
namespace {

constexpr std::size_t kLeastPoints = 100;
// Smallest standard deviation, in mm, of the points across their longest extent. Points that spread
// less nearly lie on a line and do not determine a plane.
constexpr double kLeastSpread = 2;
constexpr double kLeastInlier = 0.02;  // in mm; a point closer than this always counts as an inlier

struct PlaneEstimate {
  cv::Vec3d centre, normal;
  double spread = 0;

  double distance(const cv::Vec3d& at) const { return std::abs(normal.dot(at - centre)); }
};

double median_distance(std::span<const LaserPoint> points, const PlaneEstimate& plane) {
  std::vector<double> distances;
  distances.reserve(points.size());
  for (const LaserPoint& p : points)
    distances.push_back(plane.distance(p.at));
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::ranges::nth_element(distances, middle);
  return *middle;
}

// Returns a first estimate of the plane, by least median of squares over planes through three
// points. A fixed seed makes the result repeatable.
PlaneEstimate first_plane(std::span<const LaserPoint> points) {
  constexpr int kTrials = 200;
  constexpr std::size_t kJudges = 2000;
  std::mt19937 random(1);
  std::vector<LaserPoint> judges;
  for (std::size_t i = 0; i < std::min(kJudges, points.size()); ++i)
    judges.push_back(points[i * points.size() / std::min(kJudges, points.size())]);
  PlaneEstimate best;
  double least = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto pick = [&] { return points[random() % points.size()].at; };
    const cv::Vec3d p = pick(), q = pick(), r = pick(), normal = (q - p).cross(r - p);
    if (cv::norm(normal) < 1) continue;  // mm²: the three points nearly lie on a line
    const PlaneEstimate plane{p, cv::normalize(normal)};
    const double median = median_distance(judges, plane);
    if (median < least) {
      least = median;
      best = plane;
    }
  }
  return best;
}

// Fits a plane by least squares to the points near the plane `around`.
PlaneEstimate refined(std::span<const LaserPoint> points, const PlaneEstimate& around) {
  const double reach = std::max(3 * 1.4826 * median_distance(points, around), kLeastInlier);
  cv::Vec3d sum;
  double count = 0;
  for (const LaserPoint& p : points) {
    if (around.distance(p.at) > reach) continue;
    sum += p.at;
    ++count;
  }
  PlaneEstimate plane{sum / count, {}};
  cv::Matx33d covariance = cv::Matx33d::zeros();
  for (const LaserPoint& p : points) {
    if (around.distance(p.at) > reach) continue;
    const cv::Vec3d d = p.at - plane.centre;
    covariance += d * d.t();
  }
  cv::Vec3d values;  // eigenvalues, descending
  cv::Matx33d vectors;
  cv::eigen(covariance, values, vectors);
  plane.normal = {vectors(2, 0), vectors(2, 1), vectors(2, 2)};
  plane.spread = std::sqrt(std::max(values[1], 0.0) / count);
  return plane;
}

}  // namespace

cv::Vec3d LightPlane::within(const cv::Vec3d& at) const {
  const cv::Vec3d d = at - origin;
  return {x.dot(d), y.dot(d), normal.dot(d)};
}

TurntableAxis LightPlane::axis(const CameraFrameAxis& table) const {
  const cv::Vec3d direction(x.dot(table.direction), y.dot(table.direction),
                            normal.dot(table.direction));
  const cv::Vec3d point = within(table.point);
  TurntableAxis axis;
  axis.b = direction[0] / direction[1];
  axis.tilt = direction[2] / direction[1];
  axis.a = point[0] - axis.b * point[1];
  axis.offset = point[2] - axis.tilt * point[1];
  axis.is_clockwise = direction[1] < 0;
  return axis;
}

std::vector<cv::Vec3d> rays(const CameraModel& camera, std::span<const ImagePoint> pixels) {
  if (pixels.empty()) return {};
  std::vector<cv::Point2d> distorted, straight;
  for (const ImagePoint& p : pixels)
    distorted.emplace_back(p.u, p.v);
  cv::undistortPoints(distorted, straight, camera.matrix, camera.distortion, cv::noArray(),
                      cv::noArray(),
                      cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-10));
  std::vector<cv::Vec3d> directions;
  directions.reserve(straight.size());
  for (const cv::Point2d& p : straight)
    directions.push_back(cv::normalize(cv::Vec3d(p.x, p.y, 1)));
  return directions;
}

cv::Vec3d meet(const cv::Vec3d& ray, const cv::Vec3d& origin, const cv::Vec3d& normal) {
  constexpr double kLeastSine = 0.1;
  const double sine = normal.dot(ray);
  if (std::abs(sine) < kLeastSine) return cv::Vec3d::all(std::nan(""));
  return ray * (normal.dot(origin) / sine);
}

Expected<LightPlane> fit_light_plane(std::span<const LaserPoint> points, const CameraModel& camera,
                                     int width, int height) {
  if (points.size() < kLeastPoints) {
    return fail(
        ErrorCode::kBadInput,
        "too little of the laser line is seen on the target; place the target where the laser "
        "meets it, and lower the exposure until its white squares are grey");
  }
  PlaneEstimate plane = first_plane(points);
  for (int i = 0; i < 10; ++i)
    plane = refined(points, plane);
  if (!(plane.spread > kLeastSpread)) {
    return fail(ErrorCode::kBadInput,
                "the laser line always met the target in the same place; show the target nearer "
                "to the camera, farther from it, and turned");
  }
  const ImagePoint centre{(width - 1) / 2.0, (height - 1) / 2.0};
  LightPlane light;
  light.origin = meet(rays(camera, std::span(&centre, 1)).front(), plane.centre, plane.normal);
  const cv::Vec3d up(0, -1, 0), upwards = up - plane.normal * plane.normal.dot(up);
  if (!std::isfinite(light.origin[0]) || cv::norm(upwards) < 0.5) {
    return fail(ErrorCode::kBadInput,
                "the laser line is not upright in the picture; turn the laser until its "
                "line runs from the top of the picture to its bottom");
  }
  light.y = cv::normalize(upwards);
  light.normal = plane.normal;
  light.x = light.y.cross(light.normal);
  if (light.x[0] < 0) {
    light.normal = -light.normal;
    light.x = -light.x;
  }
  return light;
}

}  // namespace vitrine::acquisition
