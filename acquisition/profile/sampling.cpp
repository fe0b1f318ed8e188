// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/sampling.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "acquisition/profile/adaptive_windows.h"

namespace vitrine {
namespace {

using Points = std::span<const ProfilePoint>;

std::uint8_t flags_of(Points points) {
  std::uint8_t any = 0, all = kFilled;
  for (const ProfilePoint& p : points)
    any |= p.flags, all &= p.flags;
  return static_cast<std::uint8_t>((any & ~kFilled) | all);
}

ProfilePoint mean_of(Points points) {
  ProfilePoint mean{.row = points[(points.size() - 1) / 2].row, .flags = flags_of(points)};
  for (const ProfilePoint& p : points)
    mean.at.rho += p.at.rho, mean.at.lateral += p.at.lateral, mean.at.z += p.at.z;
  const auto n = static_cast<double>(points.size());
  mean.at = {mean.at.rho / n, mean.at.lateral / n, mean.at.z / n};
  return mean;
}

bool is_within_three_sigma(Points points) {
  const double mean = mean_of(points).at.rho;
  double squares = 0, largest = 0;
  for (const ProfilePoint& p : points) {
    const double d = std::abs(p.at.rho - mean);
    squares += d * d, largest = std::max(largest, d);
  }
  return points.size() < 2 ||
         largest <= 3 * std::sqrt(squares / static_cast<double>(points.size() - 1));
}

template <class Take>
void for_blocks(Points points, std::size_t length, Take take) {
  for (std::size_t i = 0; i < points.size(); i += length)
    take(points.subspan(i, std::min(length, points.size() - i)));
}

void sample_equidistantly(Points points, std::size_t length, std::vector<ProfilePoint>& kept) {
  std::uint8_t apart = 0;  // among those left out since the last
  for_blocks(points, length, [&](Points block) {
    kept.push_back(block.front());
    kept.back().flags |= apart;
    apart = flags_of(block.subspan(1)) & kApart;
  });
}

void sample_as_paper(Points points, std::size_t length, std::vector<ProfilePoint>& kept) {
  for_blocks(points, length, [&](Points block) {
    if (is_within_three_sigma(block))
      kept.push_back(mean_of(block));
    else
      kept.insert(kept.end(), block.begin(), block.end());
  });
}

// The window's line at one of its points.
ProfilePoint end_of(Points points, const Window& window, std::size_t at) {
  ProfilePoint end = points[at];
  end.flags = flags_of(points.subspan(window.first, window.count));
  const TablePoint& origin = points[0].at;  // of the line's coordinates
  const auto [rho, z] = window.line.onto(end.at.rho - origin.rho, end.at.z - origin.z);
  end.at.rho = origin.rho + rho, end.at.z = origin.z + z;
  return end;
}

void sample_adaptively(Points points, const SamplingOptions& options,
                       std::vector<ProfilePoint>& kept) {
  const auto length = static_cast<std::size_t>(options.window);
  const auto windows = adaptive_windows(points, {.windows = (points.size() + length - 1) / length,
                                                 .longest = 4 * length,
                                                 .noise = options.noise});
  for (const Window& w : windows) {
    const std::size_t last = w.first + w.count - 1;
    const bool starts = w.first == 0 || (points[w.first].flags & kApart);
    const bool ends = last + 1 == points.size() || (points[last + 1].flags & kApart);
    if (starts) kept.push_back(end_of(points, w, w.first));
    if (!starts && !ends) kept.push_back(mean_of(points.subspan(w.first, w.count)));
    if (ends && !(starts && w.count == 1)) {
      kept.push_back(end_of(points, w, last));
      if (starts) kept.back().flags &= static_cast<std::uint8_t>(~kApart);
    }
  }
}

}  // namespace

Profile sample(const Profile& profile, const SamplingOptions& options) {
  const auto length = static_cast<std::size_t>(std::max(options.window, 1));
  Profile sampled{profile.theta, {}};
  if (length == 1) return profile;
  switch (options.method) {
    case SamplingMethod::kEquidistant:
      sample_equidistantly(profile.points, length, sampled.points);
      break;
    case SamplingMethod::kPaper:
      sample_as_paper(profile.points, length, sampled.points);
      break;
    case SamplingMethod::kAdaptive:
      sample_adaptively(profile.points, options, sampled.points);
  }
  return sampled;
}

}  // namespace vitrine
