// SPDX-License-Identifier: Apache-2.0
// Watches whether a scan that started well still shows a usable stripe. An object may leave the
// laser plane, or show two stripes, for a few steps. A failed laser, daylight or a second laser
// affects the rest of the revolution.
#pragma once

#include <algorithm>
#include <vector>

#include "acquisition/profile/judge.h"

namespace vitrine::acquisition {

class StripeWatch {
 public:
  // Watches a scan with `steps_of_a_turn` steps per revolution. Does not judge its first `accepted`
  // steps.
  StripeWatch(int steps_of_a_turn, int accepted)
      : most_(static_cast<std::size_t>(std::max(steps_of_a_turn / 8, 3))), accepted_(accepted) {}

  // Adds the step with number `steps_done` and judges the last eighth of a revolution. Fails with
  // kBadInput if judge() refuses that eighth for a reason other than saturation. Reports each
  // reason once, because an operator who resumes the scan accepts it. Reports a lost stripe again
  // if the stripe was found in between. Reports other reasons again only after an eighth of a
  // revolution without any of them, because an object may stay close to the limit.
  Expected<void> add(const StripeCount& stripe, int steps_done);

  // Returns the number of steps that are judged together.
  int span() const { return static_cast<int>(most_); }

 private:
  const std::size_t most_;
  const int accepted_;
  std::vector<StripeCount> last_;
  std::size_t good_ = 0;  // number of good judgements in a row
  // Whether a lost stripe (is_lost_) or another fault of the stripe (is_odd_) has been reported.
  bool is_lost_ = false, is_odd_ = false;
};

}  // namespace vitrine::acquisition
