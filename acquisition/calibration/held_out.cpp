// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/held_out.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace vitrine {
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
    return fail(ErrorCode::kBadInput,
                "no pose lies where the others are: nothing judges the calibration; show the "
                "target in more poses, close to each other");
  }
  return points;
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
                fmt::format("the laser line was seen on {} poses, {} are the least to judge a "
                            "calibration by; show the target in more poses",
                            poses, kLeastPoses));
  }
  CrossValidation result;
  Expected<std::vector<HeldOutPoint>> all[PlaneMap::kMostDegree + 1];
  const std::vector<HeldOutPoint>* chosen = nullptr;
  double best = 0;
  for (int d = PlaneMap::kLeastDegree; d <= PlaneMap::kMostDegree; ++d) {
    all[d] = judge(poses, d, leave_out);
    if (!all[d]) {
      if (d == degree) return tl::make_unexpected(all[d].error());
      continue;
    }
    const ResidualSummary residuals = summary_of(*all[d]);
    if (result.degrees.empty() || residuals.rms < best) best = residuals.rms;
    result.degrees.push_back({d, 0, residuals});
  }
  for (const DegreeResult& d : result.degrees) {
    const bool taken = degree == 0 ? d.residuals.rms <= best * kAsGood : d.degree == degree;
    if (!taken) continue;
    result.degree = d.degree;
    chosen = &*all[d.degree];
    break;
  }
  if (chosen == nullptr) {
    return degree == 0 ? tl::make_unexpected(all[PlaneMap::kLeastDegree].error())
                       : fail(ErrorCode::kBadInput,
                              fmt::format("a plane map of degree {} is not offered; choose 2 to 5, "
                                          "or 0 for the best of them",
                                          degree));
  }
  result.points = *chosen;
  return result;
}

}  // namespace vitrine
