// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/sampling.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "acquisition/profile/adaptive_windows.h"
#include "acquisition/profile/fit_polyline.h"

namespace vitrine::acquisition {
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
  // kApart if a point that was omitted since the last kept point has that flag, otherwise 0.
  std::uint8_t apart = 0;
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

// Returns the point of the window's line that is closest to the window's point `at`.
ProfilePoint end_of(Points points, const Window& window, std::size_t at) {
  ProfilePoint end = points[at];
  end.flags = flags_of(points.subspan(window.first, window.count));
  const TablePoint& origin = points[0].at;  // the line is relative to this point
  const auto [rho, z] = window.line.onto(end.at.rho - origin.rho, end.at.z - origin.z);
  end.at.rho = origin.rho + rho, end.at.z = origin.z + z;
  return end;
}

// Returns the points of all profiles in one sequence. The flag kApart separates the profiles.
std::vector<ProfilePoint> chain(std::span<const Profile> profiles) {
  std::vector<ProfilePoint> points;
  for (const Profile& profile : profiles) {
    const std::size_t first = points.size();
    points.insert(points.end(), profile.points.begin(), profile.points.end());
    if (first < points.size()) points[first].flags |= kApart;
  }
  return points;
}

// Returns the points that represent one profile. A point flagged kApart begins a part. Each part is
// represented by its two ends and the means of the windows between them.
std::vector<ProfilePoint> corners_of(Points points, std::span<const Window> windows) {
  std::vector<ProfilePoint> kept;
  std::vector<PolylineVertex> part;
  for (const Window& w : windows) {
    const std::size_t last = w.first + w.count - 1;
    const bool starts = points[w.first].flags & kApart;
    const bool ends = last + 1 == points.size() || (points[last + 1].flags & kApart);
    const auto from = static_cast<double>(w.first), to = static_cast<double>(last);
    if (starts) part.push_back({end_of(points, w, w.first), from});
    if (!starts && !ends)
      part.push_back({mean_of(points.subspan(w.first, w.count)), (from + to) / 2});
    if (ends && !(starts && w.count == 1)) {
      part.push_back({end_of(points, w, last), to});
      if (starts) part.back().point.flags &= static_cast<std::uint8_t>(~kApart);
    }
    if (!ends) continue;
    fit_polyline(points, part);
    for (const PolylineVertex& corner : part)
      kept.push_back(corner.point);
    part.clear();
  }
  return kept;
}

void share_points(std::span<Profile> profiles, const SamplingOptions& options) {
  const std::vector<ProfilePoint> points = chain(profiles);
  const auto length = static_cast<std::size_t>(options.window);
  const auto windows = adaptive_windows(points, {.windows = (points.size() + length - 1) / length,
                                                 .longest = 2 * length,
                                                 .noise = options.noise});
  auto window = windows.begin();
  std::size_t behind = 0;
  for (Profile& profile : profiles) {
    behind += profile.points.size();
    const auto first = window;
    while (window != windows.end() && window->first < behind)
      ++window;
    profile.points = corners_of(points, {first, window});
  }
}

// Processes the profiles in blocks to bound the memory used.
void sample_adaptively(std::span<Profile> profiles, const SamplingOptions& options) {
  // Largest number of points in a block, unless one profile has more.
  constexpr std::size_t kShared = 2'000'000;
  while (!profiles.empty()) {
    std::size_t count = 1, points = profiles[0].points.size();
    while (count < profiles.size() && (points += profiles[count].points.size()) <= kShared)
      ++count;
    share_points(profiles.first(count), options);
    profiles = profiles.subspan(count);
  }
}

template <class Sample>
void sample_each(std::span<Profile> profiles, Sample sample) {
  for (Profile& profile : profiles) {
    std::vector<ProfilePoint> kept;
    sample(profile.points, kept);
    profile.points = std::move(kept);
  }
}

}  // namespace

void sample(std::span<Profile> profiles, const SamplingOptions& options) {
  const auto length = static_cast<std::size_t>(std::max(options.window, 1));
  if (length == 1) return;
  switch (options.method) {
    case SamplingMethod::kEquidistant:
      sample_each(profiles, [=](Points points, std::vector<ProfilePoint>& kept) {
        sample_equidistantly(points, length, kept);
      });
      break;
    case SamplingMethod::kPaper:
      sample_each(profiles, [=](Points points, std::vector<ProfilePoint>& kept) {
        sample_as_paper(points, length, kept);
      });
      break;
    case SamplingMethod::kAdaptive:
      sample_adaptively(profiles, options);
  }
}

}  // namespace vitrine::acquisition
