// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/cloud.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vitrine::acquisition {
namespace {

constexpr double kDepths = 4;  // largest depth difference, in multiples of s_max ([WLL] eq. 5)
// The distance between steps is measured at the radius within which this share of the points lies.
constexpr double kOutermost = .95;

constexpr double kLeastHeight = 1e-3;  // in mm; the rows of a real camera are farther apart

// In sampled profiles, the distances between rows vary. Two consecutive points then have a gap
// between them only if they are farther apart than this multiple of the median number of rows.
constexpr int kSampledGap = 4;

template <class T>
T percentile(std::vector<T>& values, double part) {
  if (values.empty()) return {};
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double median_step(const Cloud& cloud) {
  std::vector<double> steps;
  for (std::size_t s = 1; s < cloud.step_count(); ++s)
    steps.push_back(cloud.strands[cloud.steps[s]].theta - cloud.strands[cloud.steps[s - 1]].theta);
  return percentile(steps, .5) * std::numbers::pi / 180;
}

}  // namespace

Cloud::Cloud(std::vector<Profile> given) : strands(std::move(given)) {
  std::ranges::stable_sort(strands, {}, &Profile::theta);
  steps = steps_of(strands);
  first.push_back(0);
  for (const Profile& strand : strands) {
    for (const ProfilePoint& point : strand.points)
      positions.push_back(position(strand, point));
    first.push_back(positions.size());
  }
}

std::vector<std::size_t> steps_of(std::span<const Profile> strands) {
  std::vector<std::size_t> steps;
  for (std::size_t k = 0; k < strands.size(); ++k) {
    if (k == 0 || strands[k].theta != strands[k - 1].theta) steps.push_back(k);
  }
  steps.push_back(strands.size());
  return steps;
}

std::vector<Profile> keep(const Cloud& cloud, const std::vector<bool>& kept) {
  std::vector<Profile> strands;
  for (std::size_t k = 0; k < cloud.strands.size(); ++k) {
    const Profile& from = cloud.strands[k];
    Profile to{from.theta, {}};
    for (std::size_t i = 0; i < from.points.size(); ++i) {
      if (kept[cloud.first[k] + i]) to.points.push_back(from.points[i]);
    }
    strands.push_back(std::move(to));
  }
  return strands;
}

Spacing spacing_of(const Cloud& cloud, const SurfaceOptions& options) {
  std::vector<double> along, heights, radii;
  std::vector<int> rows;
  for (const Profile& strand : cloud.strands) {
    for (std::size_t i = 0; i < strand.points.size(); ++i) {
      const ProfilePoint& p = strand.points[i];
      radii.push_back(std::hypot(p.at.rho, p.at.lateral));
      if (i == 0) continue;
      const ProfilePoint& q = strand.points[i - 1];
      rows.push_back(p.row - q.row);
      heights.push_back(std::abs(p.at.z - q.at.z) / (p.row - q.row));
      along.push_back(std::hypot(p.at.rho - q.at.rho, p.at.z - q.at.z));
    }
  }
  Spacing spacing;
  spacing.rows = std::max(1, percentile(rows, .5));
  spacing.gap = spacing.rows == 1 ? 1 : kSampledGap * spacing.rows;
  spacing.largest =
      options.largest_spacing > 0
          ? options.largest_spacing
          : std::max(percentile(along, .5), median_step(cloud) * percentile(radii, kOutermost));
  spacing.row_height = std::max(percentile(heights, .5), kLeastHeight);
  spacing.near = kDepths * spacing.largest;
  spacing.bridge = std::max(spacing.near, options.largest_hole);
  spacing.cos_largest = std::cos(options.largest_angle * std::numbers::pi / 180);
  return spacing;
}

bool are_joined(double depth, double distance, const Spacing& spacing) {
  if (depth < spacing.near) return true;
  const double across = std::sqrt(std::max(0., distance * distance - depth * depth));
  return across > spacing.cos_largest * distance;
}

}  // namespace vitrine::acquisition
