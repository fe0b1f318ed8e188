// SPDX-License-Identifier: Apache-2.0
// Cross-validation: judges the points of each pose by a map that was fitted without that pose.
#pragma once

#include <functional>
#include <span>

#include "acquisition/calibration/report.h"

namespace vitrine::acquisition {

// A function that fits a map of a given degree without the left-out poses, and returns the
// residuals of these poses.
using LeaveOut = std::function<Expected<std::vector<HeldOutPoint>>(
    const std::vector<bool>& left_out, int degree)>;

struct CrossValidation {
  // The results of all degrees that could be fitted. Their condition numbers are not set.
  std::vector<DegreeResult> degrees;
  int degree = 0;                    // the chosen degree
  std::vector<HeldOutPoint> points;  // residuals at the chosen degree
};

// Judges plane maps by poses left out of the fit. If `degree` is 0, chooses the lowest degree whose
// rms, without outliers, is within 1 % of the best. Fails with kBadInput if there are fewer than 3
// poses or the degree cannot be fitted.
Expected<CrossValidation> cross_validate(int poses, int degree, const LeaveOut& leave_out);

ResidualSummary summary_of(std::span<const HeldOutPoint> points);

}  // namespace vitrine::acquisition
