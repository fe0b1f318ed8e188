// SPDX-License-Identifier: Apache-2.0
// Cross-validation: every pose is judged once by a map that was fitted without it.
#pragma once

#include <functional>
#include <span>

#include "acquisition/calibration/report.h"

namespace vitrine {

// Fits a map of that degree to the poses that are not left out, and judges those that are.
using LeaveOut = std::function<Expected<std::vector<HeldOutPoint>>(
    const std::vector<bool>& left_out, int degree)>;

struct CrossValidation {
  std::vector<DegreeResult> degrees;  // those that could be fitted, without their condition
  int degree = 0;                     // chosen
  std::vector<HeldOutPoint> points;   // of the chosen one
};

// `degree` 0 chooses: the lowest that is within a hundredth of the best. Fails (kBadInput) with
// fewer than 3 poses, or where the degree cannot be fitted.
Expected<CrossValidation> cross_validate(int poses, int degree, const LeaveOut& leave_out);

ResidualSummary summary_of(std::span<const HeldOutPoint> points);

}  // namespace vitrine
