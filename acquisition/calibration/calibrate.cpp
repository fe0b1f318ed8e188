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

namespace vitrine::acquisition {
namespace {

std::string now() {
  const std::time_t time = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  ::gmtime_r(&time, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1,
                     utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec);
}

bool is_of_target(const TargetView& view, const CharucoTarget& target) {
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
                "a picture has corners that the target does not have; detect them with the same "
                "target");
  }
  return {};
}

// Returns the corners that each picture shows, with the placements renumbered to 0, 1, 2, …
std::vector<SeenTarget> seen_targets(const CalibrationInput& input) {
  std::map<int, int> placements;
  std::vector<SeenTarget> all;
  for (const TargetPicture& picture : input.pictures) {
    const int next = static_cast<int>(placements.size());
    SeenTarget seen{.placement = placements.try_emplace(picture.placement, next).first->second,
                    .angle = picture.angle * std::numbers::pi / 180};
    for (std::size_t i = 0; i < picture.view.ids.size(); ++i) {
      const TargetPoint on = corner_on(input.target, picture.view.ids[i]);
      seen.on_board.emplace_back(on.x, on.y, 0);
      seen.in_image.emplace_back(picture.view.corners[i].u, picture.view.corners[i].v);
    }
    all.push_back(std::move(seen));
  }
  return all;
}

// Returns the laser's line on the target in 3D, by intersecting the viewing rays with the target's
// plane. Points outside the target's outline are left out.
std::vector<LaserPoint> on_target(const CalibrationInput& input, const CalibrationScene& scene,
                                  std::span<const SeenTarget> seen) {
  const CharucoTarget& t = input.target;
  std::vector<LaserPoint> points;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const std::vector<ImagePoint>& stripe = input.pictures[i].stripe;
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

// Renumbers the poses of the points as 0, 1, 2, … and returns how many poses there are.
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

// Fits the light plane and the plane map to the poses that are not left out. Returns the residuals
// of the left-out poses.
Expected<std::vector<HeldOutPoint>> predict_left_out(std::span<const LaserPoint> stripe,
                                                     const CameraModel& camera,
                                                     const SheetArea& area,
                                                     const std::vector<bool>& left_out,
                                                     int degree) {
  const std::vector<LaserPoint> rest = kept(stripe, left_out);
  const auto plane = fit_light_plane(rest, camera, area.width, area.height);
  if (!plane) return tl::unexpected(plane.error());
  const auto map =
      PlaneMap::fit(sheet_points(rest, camera, *plane, area), degree, area.width, area.height);
  if (!map) return tl::unexpected(map.error());
  std::vector<HeldOutPoint> judged;
  for (const LaserPoint& p : stripe) {
    const auto predicted = map->at(p.in_image.u, p.in_image.v);
    if (!left_out[p.pose] || !predicted) continue;
    const cv::Vec3d d = p.at - plane->origin - predicted->x * plane->x - predicted->y * plane->y;
    judged.push_back({.u = p.in_image.u,
                      .v = p.in_image.v,
                      .dx = plane->x.dot(d),
                      .dy = plane->y.dot(d),
                      .dw = plane->normal.dot(d),
                      .pose = p.pose});
  }
  return judged;
}

// Fits a map to known coordinates in the laser plane, without the left-out poses. Returns the
// residuals of the left-out poses. Their `dw` is 0, because no light plane is fitted.
Expected<std::vector<HeldOutPoint>> predict_left_out(std::span<const Correspondence> points,
                                                     const SensorRegion& region,
                                                     const std::vector<bool>& left_out,
                                                     int degree) {
  const auto map = PlaneMap::fit(kept(points, left_out), degree, region.width, region.height);
  if (!map) return tl::unexpected(map.error());
  std::vector<HeldOutPoint> judged;
  for (const Correspondence& p : points) {
    const auto predicted = map->at(p.u, p.v);
    if (!left_out[p.pose] || !predicted) continue;
    judged.push_back({.u = p.u,
                      .v = p.v,
                      .dx = p.at.x - predicted->x,
                      .dy = p.at.y - predicted->y,
                      .dw = 0,
                      .pose = p.pose});
  }
  return judged;
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
  return {.image_share = map.image_share(region.width, region.height),
          .x_low = x_low,
          .x_high = x_high,
          .y_low = y_low,
          .y_high = y_high};
}

// Returns the calibration with its report. For each degree, adds to the report the condition number
// of the fit to all points.
Expected<Calibrated> assemble(CrossValidation validation, std::span<const Correspondence> points,
                              const std::string& camera, const SensorRegion& region) {
  Calibrated result;
  for (DegreeResult& d : validation.degrees) {
    const auto map = PlaneMap::fit(points, d.degree, region.width, region.height);
    if (!map) return tl::unexpected(map.error());
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

void report_scene(const CalibrationScene& scene, std::span<const SeenTarget> seen,
                  CalibrationReport& report) {
  std::vector<double> misfits;
  for (std::size_t i = 0; i < seen.size(); ++i)
    misfits.push_back(misfit(scene, seen[i], i));
  report.pictures = static_cast<int>(seen.size());
  report.reprojection = root_mean_square(misfits);
  report.table_error = root_mean_square(scene.slips) * 180 / std::numbers::pi;
}

}  // namespace

Expected<Calibrated> calibrate(const CalibrationInput& input, const CalibrationOptions& options) {
  if (auto ok = check_input(input); !ok) return tl::unexpected(ok.error());
  const SensorRegion& region = input.region;
  const std::vector<SeenTarget> seen = seen_targets(input);
  const auto scene = solve_scene(seen, region.width, region.height);
  if (!scene) return tl::unexpected(scene.error());
  auto straight = straight_stripe(on_target(input, *scene, seen), scene->camera);
  if (!straight) return tl::unexpected(straight.error());
  std::vector<LaserPoint>& stripe = straight->points;
  const auto light = fit_light_plane(stripe, scene->camera, region.width, region.height);
  if (!light) return tl::unexpected(light.error());
  const int poses = number_poses(stripe);

  const SheetArea area{options.margin, region.width, region.height};
  const auto validation =
      cross_validate(poses, options.degree, [&](const std::vector<bool>& left_out, int degree) {
        return predict_left_out(stripe, scene->camera, area, left_out, degree);
      });
  if (!validation) return tl::unexpected(validation.error());
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

Expected<Calibrated> calibrate(std::span<const Correspondence> points, const TurntableAxis& axis,
                               const std::string& camera, const SensorRegion& region,
                               const CalibrationOptions& options) {
  std::vector<Correspondence> all(points.begin(), points.end());
  std::map<int, int> numbers;
  for (Correspondence& p : all) {
    const int next = static_cast<int>(numbers.size());
    p.pose = numbers.try_emplace(p.pose, next).first->second;
  }
  // Cross-validation judges each pose by a map that is fitted to the other poses, which must be at
  // least two.
  constexpr std::size_t kLeastPoses = 3;
  if (numbers.size() < kLeastPoses) {
    return fail(ErrorCode::kBadInput,
                fmt::format("the points have {} different pose numbers, a calibration needs at "
                            "least {}; number points measured together alike, and add poses",
                            numbers.size(), kLeastPoses));
  }
  const auto validation = cross_validate(static_cast<int>(numbers.size()), options.degree,
                                         [&](const std::vector<bool>& left_out, int degree) {
                                           return predict_left_out(all, region, left_out, degree);
                                         });
  if (!validation) return tl::unexpected(validation.error());
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

}  // namespace vitrine::acquisition
