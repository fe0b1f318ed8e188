// SPDX-License-Identifier: Apache-2.0
// Watches whether a scan that started well still shows a usable stripe. For some steps an object
// may leave the laser plane, or show two stripes. A failed laser, daylight or a second laser
// affects the rest of the revolution.
#pragma once

#include <algorithm>
#include <vector>

#include "acquisition/profile/judge.h"

namespace vitrine::acquisition {

class StripeWatch {
 public:
  // Reports nothing for the first `accepted` steps.
  StripeWatch(int steps_of_a_turn, int accepted)
      : most_(static_cast<std::size_t>(std::max(steps_of_a_turn / 8, 3))), accepted_(accepted) {}

  // Adds the next step, whose number is `steps_done`, and judges the last eighth of a revolution.
  // Fails with kBadInput if judge() refuses that eighth for a reason other than saturation. Each
  // condition is reported once, because resuming the scan accepts the condition. A stripe that is
  // found and lost again is reported again. Other conditions are reported again only after an
  // eighth of a revolution without any, because an object may stay close to the limit.
  Expected<void> add(const StripeCount& stripe, int steps_done);

  // Returns the number of steps that are judged, and may be refused, together.
  int span() const { return static_cast<int>(most_); }

 private:
  const std::size_t most_;
  const int accepted_;
  std::vector<StripeCount> last_;
  std::size_t good_ = 0;  // number of consecutive good judgements
  // Whether a lost stripe, or another condition, has been reported.
  bool is_lost_ = false, is_odd_ = false;
};

}  // namespace vitrine::acquisition
