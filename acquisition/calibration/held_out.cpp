// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/held_out.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace vitrine::acquisition {
namespace {

constexpr int kMostFolds = 10, kLeastPoses = 3;
constexpr double kAsGood = 1.01;

Expected<std::vector<HeldOutPoint>> judge(int poses, int degree, const LeaveOut& leave_out) {
  const int folds = std::min(poses, kMostFolds);
  std::vector<HeldOutPoint> points;
  for (int fold = 0; fold < folds; ++fold) {
    std::vector<bool> left_out(poses);
    for (int pose = fold; pose < poses; pose += folds)
      left_out[pose] = true;
    auto judged = leave_out(left_out, degree);
    if (!judged) return judged;
    points.insert(points.end(), judged->begin(), judged->end());
  }
  if (points.empty()) {
    return fail(
        ErrorCode::kBadInput,
        "no pose lies within the area of the others, so the calibration cannot be judged; show the "
        "target in more poses, close to each other");
  }
  return points;
}

// Returns the root mean square of the residuals without outliers. Outliers are wrongly detected
// corners or stripes. They do not show which degree fits best.
double without_strays(std::span<const HeldOutPoint> points) {
  constexpr double kFar = 4;  // residuals beyond this multiple of the median are outliers
  std::vector<double> sizes;
  for (const HeldOutPoint& p : points)
    sizes.push_back(p.size());
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);
  double sum = 0, count = 0;
  for (const double size : sizes) {
    if (size <= kFar * *middle) sum += size * size, ++count;
  }
  return std::sqrt(sum / count);
}

}  // namespace

double HeldOutPoint::size() const {
  return std::sqrt(dx * dx + dy * dy + dw * dw);
}

ResidualSummary summary_of(std::span<const HeldOutPoint> points) {
  if (points.empty()) return {};
  std::vector<double> sizes;
  double sum = 0;
  for (const HeldOutPoint& p : points) {
    sizes.push_back(p.size());
    sum += p.size() * p.size();
  }
  std::ranges::sort(sizes);
  const auto count = sizes.size();
  return {.rms = std::sqrt(sum / static_cast<double>(count)),
          .p95 = sizes[(count * 95 + 99) / 100 - 1],
          .max = sizes.back()};
}

Expected<CrossValidation> cross_validate(int poses, int degree, const LeaveOut& leave_out) {
  if (poses < kLeastPoses) {
    return fail(ErrorCode::kBadInput,
                fmt::format("the laser line was seen in {} poses, a calibration needs at least {}; "
                            "show the target in more poses",
                            poses, kLeastPoses));
  }
  CrossValidation result;
  Expected<std::vector<HeldOutPoint>> all[PlaneMap::kMostDegree + 1];
  const std::vector<HeldOutPoint>* chosen = nullptr;
  double misses[PlaneMap::kMostDegree + 1] = {};
  double best = 0;
  for (int d = PlaneMap::kLeastDegree; d <= PlaneMap::kMostDegree; ++d) {
    all[d] = judge(poses, d, leave_out);
    if (!all[d]) {
      if (d == degree) return tl::unexpected(all[d].error());
      continue;
    }
    const ResidualSummary residuals = summary_of(*all[d]);
    misses[d] = without_strays(*all[d]);
    if (result.degrees.empty() || misses[d] < best) best = misses[d];
    result.degrees.push_back({d, 0, residuals});
  }
  for (const DegreeResult& d : result.degrees) {
    const bool taken = degree == 0 ? misses[d.degree] <= best * kAsGood : d.degree == degree;
    if (!taken) continue;
    result.degree = d.degree;
    chosen = &*all[d.degree];
    break;
  }
  if (chosen == nullptr) {
    return degree == 0
               ? tl::unexpected(all[PlaneMap::kLeastDegree].error())
               : fail(ErrorCode::kBadInput,
                      fmt::format("a plane map of degree {} is not supported; choose 2 to 5, "
                                  "or 0 for the best of them",
                                  degree));
  }
  result.points = *chosen;
  return result;
}

}  // namespace vitrine::acquisition
