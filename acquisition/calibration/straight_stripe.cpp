// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/straight_stripe.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <random>

namespace vitrine::acquisition {
namespace {

constexpr double kSigmas = 6;
constexpr double kStripeWidth = 2.5;  // width of the stripe, in pixels
constexpr std::size_t kLeastOnLine = 10;

struct ImageLine {
  cv::Point2f through, across;

  double distance(const cv::Point2f& p) const { return std::abs(across.dot(p - through)); }
};

// Returns the points as a camera without lens distortion would see them, in pixels from the
// principal point.
std::vector<cv::Point2f> undistorted(std::span<const LaserPoint> points,
                                     const CameraModel& camera) {
  std::vector<cv::Point2f> straight;
  straight.reserve(points.size());
  for (const LaserPoint& p : points) {
    straight.emplace_back(static_cast<float>(camera.matrix(0, 0) * p.at[0] / p.at[2]),
                          static_cast<float>(camera.matrix(1, 1) * p.at[1] / p.at[2]));
  }
  return straight;
}

double median_distance(std::span<const cv::Point2f> points, const ImageLine& line) {
  std::vector<double> distances;
  distances.reserve(points.size());
  for (const cv::Point2f& p : points)
    distances.push_back(line.distance(p));
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::ranges::nth_element(distances, middle);
  return *middle;
}

// Returns a first estimate of the line, by least median of squares over lines through two points. A
// fixed seed makes the result repeatable.
ImageLine first_line(std::span<const cv::Point2f> points) {
  constexpr int kTrials = 100;
  std::mt19937 random(1);
  ImageLine best{points.front(), {1, 0}};
  double least = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto pick = [&] { return points[random() % points.size()]; };
    const cv::Point2f p = pick(), d = pick() - p;
    const auto length = static_cast<float>(cv::norm(d));
    if (length < 1) continue;  // points less than a pixel apart give no reliable direction
    const ImageLine line{p, {d.y / length, -d.x / length}};
    const double median = median_distance(points, line);
    if (median < least) least = median, best = line;
  }
  return best;
}

double reach(std::span<const cv::Point2f> points, const ImageLine& line) {
  return std::max(kSigmas * 1.4826 * median_distance(points, line), kStripeWidth);
}

// Fits a line by least squares to the points near the line `around`.
ImageLine refined(std::span<const cv::Point2f> points, const ImageLine& around) {
  const double near = reach(points, around);
  std::vector<cv::Point2f> on_line;
  std::ranges::copy_if(points, std::back_inserter(on_line),
                       [&](const cv::Point2f& p) { return around.distance(p) <= near; });
  cv::Vec4f line;  // direction of the line, then a point on it
  cv::fitLine(on_line, line, cv::DIST_L2, 0, 0.001, 0.001);
  return {{line[2], line[3]}, {line[1], -line[0]}};
}

// Returns the points of one picture that lie on the stripe's line. Returns an empty list if too few
// points lie on one line.
std::vector<LaserPoint> on_line(std::span<const LaserPoint> picture, const CameraModel& camera) {
  if (picture.size() < kLeastOnLine) return {};
  const std::vector<cv::Point2f> points = undistorted(picture, camera);
  const ImageLine line = refined(points, first_line(points));
  const double near = reach(points, line);
  std::vector<LaserPoint> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (line.distance(points[i]) <= near) kept.push_back(picture[i]);
  }
  if (kept.size() < kLeastOnLine || 3 * kept.size() < 2 * picture.size()) return {};
  return kept;
}

}  // namespace

Expected<StraightStripe> straight_stripe(std::span<const LaserPoint> points,
                                         const CameraModel& camera) {
  StraightStripe result;
  int pictures = 0;
  for (auto from = points.begin(); from != points.end(); ++pictures) {
    const auto to =
        std::find_if(from, points.end(), [&](const auto& p) { return p.pose != from->pose; });
    const std::vector<LaserPoint> kept = on_line({from, to}, camera);
    if (kept.empty()) ++result.unclear;
    result.points.insert(result.points.end(), kept.begin(), kept.end());
    from = to;
  }
  if (2 * result.unclear > pictures) {
    return fail(ErrorCode::kBadInput,
                fmt::format("the laser line on the target is not one straight line in {} of {} "
                            "pictures; keep the target flat, shade it from other light and cover "
                            "reflecting surfaces beside it",
                            result.unclear, pictures));
  }
  result.strays = points.size() - result.points.size();
  return result;
}

}  // namespace vitrine::acquisition
