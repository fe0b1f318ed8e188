// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/target.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>

#include "acquisition/rig_optics/noise.h"

namespace vitrine::acquisition::rig {
namespace {

// dots per mm of the print; margin of the sheet in mm
constexpr double kDotsPerMm = 12, kPaperMargin = 4;
constexpr double kInk = 0.12, kPaper = 0.7;  // albedo of ink and paper

cv::Mat print(const TargetSpec& spec) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_100);
  const auto board = cv::aruco::CharucoBoard::create(
      spec.squares_x, spec.squares_y, static_cast<float>(spec.square_mm),
      static_cast<float>(spec.marker_mm), dictionary);
  cv::Mat image;
  board->draw({static_cast<int>(spec.squares_x * spec.square_mm * kDotsPerMm),
               static_cast<int>(spec.squares_y * spec.square_mm * kDotsPerMm)},
              image);
  const int margin = static_cast<int>(kPaperMargin * kDotsPerMm);
  cv::copyMakeBorder(image, image, margin, margin, margin, margin, cv::BORDER_CONSTANT, 255);
  // Simulates bleeding ink and the averaging of light over the area of a pixel.
  cv::GaussianBlur(image, image, {}, 0.45);
  return image;
}

// Returns the frame of a sheet that faces a direction, given by azimuth and elevation, and is
// rolled in its plane. Angles are in degrees.
SubjectFrame facing(double azimuth, double elevation, double roll, const Vec3& origin) {
  constexpr double kRadians = std::numbers::pi / 180;
  const double a = azimuth * kRadians, e = elevation * kRadians, r = roll * kRadians;
  const Vec3 normal{std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
  const Vec3 right{-std::sin(a), std::cos(a), 0}, top = cross(normal, right);
  return {right * std::cos(r) + top * std::sin(r), top * std::cos(r) - right * std::sin(r), normal,
          origin};
}

TargetPose held(std::uint64_t seed, int number) {
  std::array<double, 6> by_chance{};
  for (std::size_t i = 0; i < by_chance.size(); ++i)
    by_chance[i] = uniform(key_of(seed, 0x7a49e7, 100 * static_cast<std::uint64_t>(number) + i));
  // Depths increase in equal steps. Tilts follow a different order, so that each depth range gets
  // all tilts.
  const double depth = -52 + 108.0 * number / (kHeldPoses - 1) + by_chance[0];
  const double pan = 16 * (number * 7 % 5 - 2) + 5 * by_chance[1];
  const double pitch = 13 * (number * 3 % 4 - 1.5) + 5 * by_chance[2];
  return {facing(-14 + pan, 4 + pitch, 6 * by_chance[3],
                 {depth, 3 * by_chance[4], 42 + 5 * by_chance[5]}),
          false};
}

TargetPose on_table() {
  return {facing(-14, 6, 1.5, {11, 3, 61}), true};
}

}  // namespace

PrintedTarget::PrintedTarget(const TargetSpec& spec)
    : half_x_(spec.squares_x * spec.square_mm / 2 + kPaperMargin),
      half_y_(spec.squares_y * spec.square_mm / 2 + kPaperMargin) {
  const cv::Mat image = print(spec);
  columns_ = image.cols;
  rows_ = image.rows;
  albedo_.reserve(image.total());
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      albedo_.push_back(
          static_cast<float>(kInk + (kPaper - kInk) * image.at<std::uint8_t>(row, column) / 255));
    }
  }
}

double PrintedTarget::brightness(double x, double y) const {
  const double u = std::clamp((x + half_x_) * kDotsPerMm - 0.5, 0.0, columns_ - 1.001);
  const double v = std::clamp((half_y_ - y) * kDotsPerMm - 0.5, 0.0, rows_ - 1.001);
  const int column = static_cast<int>(u), row = static_cast<int>(v);
  const double s = u - column, t = v - row;
  const float* at = albedo_.data() + static_cast<std::ptrdiff_t>(row) * columns_ + column;
  return (1 - t) * ((1 - s) * at[0] + s * at[1]) +
         t * ((1 - s) * at[columns_] + s * at[columns_ + 1]);
}

std::optional<RayHit> PrintedTarget::first_hit(const Vec3& from, const Vec3& direction) const {
  const double t = -from.z / direction.z;
  if (!(t > 0)) return std::nullopt;
  const Vec3 at = from + direction * t;
  if (std::abs(at.x) > half_x_ || std::abs(at.y) > half_y_) return std::nullopt;
  return RayHit{at, {0, 0, 1}, from.z > 0 ? brightness(at.x, at.y) : kPaper, 0};
}

void PrintedTarget::near_plane(const Vec3&, double, double,
                               const std::function<void(ConvexPolygon)>& visit) const {
  const Vec3 corners[] = {{-half_x_, -half_y_, 0},
                          {half_x_, -half_y_, 0},
                          {half_x_, half_y_, 0},
                          {-half_x_, half_y_, 0}};
  visit(corners);
}

std::vector<TargetPose> target_poses(std::uint64_t seed) {
  std::vector<TargetPose> poses;
  poses.reserve(kHeldPoses + 1);
  for (int number = 0; number < kHeldPoses; ++number)
    poses.push_back(held(seed, number));
  poses.push_back(on_table());
  return poses;
}

}  // namespace vitrine::acquisition::rig
