// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/calibrate.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "acquisition/calibration/held_out.h"
#include "acquisition/calibration/light_plane.h"
#include "acquisition/calibration/scene.h"
#include "acquisition/calibration/sheet_map.h"
#include "acquisition/calibration/straight_stripe.h"
#include "acquisition/calibration/stripe_noise.h"

namespace vitrine {
namespace {

std::string now() {
  const std::time_t time = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  ::gmtime_r(&time, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1,
                     utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec);
}

bool is_of_target(const TargetView& view, const Target& target) {
  const int corners = (target.squares_x - 1) * (target.squares_y - 1);
  const auto known = [&](int id) { return id >= 0 && id < corners; };
  return view.ids.size() >= 6 && view.ids.size() == view.corners.size() &&
         std::ranges::all_of(view.ids, known);
}

Expected<void> check_input(const CalibrationInput& input) {
  if (auto ok = check_target(input.target); !ok) return ok;
  for (const TargetPicture& picture : input.pictures) {
    if (is_of_target(picture.view, input.target) && std::isfinite(picture.angle)) continue;
    return fail(ErrorCode::kBadInput,
                "a picture holds corners that the target does not have; find them with the target "
                "that is stated");
  }
  return {};
}

// Placements by any numbers become 0, 1, 2, …
std::vector<SeenTarget> seen_targets(const CalibrationInput& input) {
  std::map<int, int> placements;
  std::vector<SeenTarget> all;
  for (const TargetPicture& picture : input.pictures) {
    const int next = static_cast<int>(placements.size());
    SeenTarget seen{.placement = placements.try_emplace(picture.placement, next).first->second,
                    .angle = picture.angle * std::numbers::pi / 180};
    for (std::size_t i = 0; i < picture.view.ids.size(); ++i) {
      const Pixel on = corner_on(input.target, picture.view.ids[i]);
      seen.on_board.emplace_back(on.u, on.v, 0);
      seen.in_image.emplace_back(picture.view.corners[i].u, picture.view.corners[i].v);
    }
    all.push_back(std::move(seen));
  }
  return all;
}

// Where the laser's line is on the target: rays cut with its plane, within its outline.
std::vector<LaserPoint> on_target(const CalibrationInput& input, const Scene& scene,
                                  std::span<const SeenTarget> seen) {
  const Target& t = input.target;
  std::vector<LaserPoint> points;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const std::vector<Pixel>& stripe = input.pictures[i].stripe;
    const cv::Affine3d pose = scene.pose(seen[i], i), back = pose.inv();
    const cv::Vec3d normal = pose.rotation() * cv::Vec3d(0, 0, 1);
    const std::vector<cv::Vec3d> directions = rays(scene.camera, stripe);
    for (std::size_t k = 0; k < stripe.size(); ++k) {
      const cv::Vec3d at = meet(directions[k], pose.translation(), normal), on = back * at;
      const bool inside = on[0] >= 0 && on[0] <= t.squares_x * t.square_mm && on[1] >= 0 &&
                          on[1] <= t.squares_y * t.square_mm;
      if (inside) points.push_back({stripe[k], at, static_cast<int>(i)});
    }
  }
  return points;
}

// Numbers the pictures that show the stripe 0, 1, 2, …; how many there are.
int number_poses(std::vector<LaserPoint>& points) {
  std::map<int, int> numbers;
  for (LaserPoint& p : points) {
    const int next = static_cast<int>(numbers.size());
    p.pose = numbers.try_emplace(p.pose, next).first->second;
  }
  return static_cast<int>(numbers.size());
}

template <class Point>
std::vector<Point> kept(std::span<const Point> points, const std::vector<bool>& left_out) {
  std::vector<Point> rest;
  std::ranges::copy_if(points, std::back_inserter(rest),
                       [&](const Point& p) { return !left_out[p.pose]; });
  return rest;
}

Coverage coverage_of(const PlaneMap& map, std::span<const Correspondence> points,
                     const SensorRegion& region) {
  const auto range = [&](double PlanePoint::*coordinate) {
    const auto value = [&](const Correspondence& p) { return p.at.*coordinate; };
    const auto [low, high] = std::ranges::minmax(points, {}, value);
    return std::pair(value(low), value(high));
  };
  const auto [x_low, x_high] = range(&PlanePoint::x);
  const auto [y_low, y_high] = range(&PlanePoint::y);
  return {map.image_share(region.width, region.height), x_low, x_high, y_low, y_high};
}

// Conditions of the fits to all points, beside what cross-validation says of each degree.
Expected<Calibrated> assemble(CrossValidation validation, std::span<const Correspondence> points,
                              const std::string& camera, const SensorRegion& region) {
  Calibrated result;
  for (DegreeResult& d : validation.degrees) {
    const auto map = PlaneMap::fit(points, d.degree, region.width, region.height);
    if (!map) return tl::make_unexpected(map.error());
    d.condition = map->condition();
    if (d.degree == validation.degree) result.calibration.map = *map;
  }
  result.report.coverage = coverage_of(result.calibration.map, points, region);
  result.report.residuals = summary_of(validation.points);
  result.report.degrees = std::move(validation.degrees);
  result.report.held_out = std::move(validation.points);
  result.calibration.residuals = result.report.residuals;
  result.calibration.created = now();
  result.calibration.camera = camera;
  result.calibration.region = region;
  return result;
}

double root_mean_square(std::span<const double> values) {
  double sum = 0;
  for (double value : values)
    sum += value * value;
  return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

void report_scene(const Scene& scene, std::span<const SeenTarget> seen, CalibrationReport& report) {
  std::vector<double> misfits;
  for (std::size_t i = 0; i < seen.size(); ++i)
    misfits.push_back(misfit(scene, seen[i], i));
  report.pictures = static_cast<int>(seen.size());
  report.reprojection = root_mean_square(misfits);
  report.table_error = root_mean_square(scene.slips) * 180 / std::numbers::pi;
}

}  // namespace

Expected<Calibrated> calibrate(const CalibrationInput& input, const CalibrationOptions& options) {
  if (auto ok = check_input(input); !ok) return tl::make_unexpected(ok.error());
  const SensorRegion& region = input.region;
  const std::vector<SeenTarget> seen = seen_targets(input);
  const auto scene = solve_scene(seen, region.width, region.height);
  if (!scene) return tl::make_unexpected(scene.error());
  auto straight = straight_stripe(on_target(input, *scene, seen), scene->camera);
  if (!straight) return tl::make_unexpected(straight.error());
  std::vector<LaserPoint>& stripe = straight->points;
  const auto light = fit_light_plane(stripe, scene->camera, region.width, region.height);
  if (!light) return tl::make_unexpected(light.error());
  const int poses = number_poses(stripe);

  const SheetArea area{options.margin, region.width, region.height};
  const auto validation = cross_validate(
      poses, options.degree,
      [&](const std::vector<bool>& left_out, int degree) -> Expected<std::vector<HeldOutPoint>> {
        const std::vector<LaserPoint> rest = kept(std::span<const LaserPoint>(stripe), left_out);
        const auto plane = fit_light_plane(rest, scene->camera, region.width, region.height);
        if (!plane) return tl::make_unexpected(plane.error());
        const auto map = PlaneMap::fit(sheet_points(rest, scene->camera, *plane, area), degree,
                                       region.width, region.height);
        if (!map) return tl::make_unexpected(map.error());
        std::vector<HeldOutPoint> judged;
        for (const LaserPoint& p : stripe) {
          const auto predicted = map->at(p.in_image.u, p.in_image.v);
          if (!left_out[p.pose] || !predicted) continue;
          const cv::Vec3d d =
              p.at - plane->origin - predicted->x * plane->x - predicted->y * plane->y;
          judged.push_back({p.in_image.u, p.in_image.v, plane->x.dot(d), plane->y.dot(d),
                            plane->normal.dot(d), p.pose});
        }
        return judged;
      });
  if (!validation) return tl::make_unexpected(validation.error());
  const std::vector<Correspondence> sheet = sheet_points(stripe, scene->camera, *light, area);
  auto result = assemble(*validation, sheet, input.camera, region);
  if (!result) return result;
  result->calibration.axis = light->axis(scene->axis);
  result->calibration.noise = stripe_noise(stripe, result->calibration.map);
  report_scene(*scene, seen, result->report);
  result->report.points = stripe.size();
  result->report.strays = straight->strays;
  result->report.unclear = straight->unclear;
  return result;
}

Expected<Calibrated> calibrate(std::span<const Correspondence> points, const Axis& axis,
                               const std::string& camera, const SensorRegion& region,
                               const CalibrationOptions& options) {
  std::vector<Correspondence> all(points.begin(), points.end());
  std::map<int, int> numbers;
  for (Correspondence& p : all) {
    const int next = static_cast<int>(numbers.size());
    p.pose = numbers.try_emplace(p.pose, next).first->second;
  }
  constexpr std::size_t kLeastPoses = 3;  // each is judged by the others
  if (numbers.size() < kLeastPoses) {
    return fail(ErrorCode::kBadInput,
                fmt::format("the points are of {} poses, {} are the least to judge a calibration "
                            "by; number those measured at one time by one pose, and add others",
                            numbers.size(), kLeastPoses));
  }
  const auto validation = cross_validate(
      static_cast<int>(numbers.size()), options.degree,
      [&](const std::vector<bool>& left_out, int degree) -> Expected<std::vector<HeldOutPoint>> {
        const auto rest = kept(std::span<const Correspondence>(all), left_out);
        const auto map = PlaneMap::fit(rest, degree, region.width, region.height);
        if (!map) return tl::make_unexpected(map.error());
        std::vector<HeldOutPoint> judged;
        for (const Correspondence& p : all) {
          const auto predicted = map->at(p.u, p.v);
          if (!left_out[p.pose] || !predicted) continue;
          judged.push_back({p.u, p.v, p.at.x - predicted->x, p.at.y - predicted->y, 0, p.pose});
        }
        return judged;
      });
  if (!validation) return tl::make_unexpected(validation.error());
  auto result = assemble(*validation, all, camera, region);
  if (!result) return result;
  result->calibration.axis = axis;
  std::vector<double> across;
  for (const HeldOutPoint& p : result->report.held_out)
    across.push_back(p.dx);
  result->calibration.noise = root_mean_square(across);
  result->report.pictures = static_cast<int>(numbers.size());
  result->report.points = all.size();
  return result;
}

}  // namespace vitrine
