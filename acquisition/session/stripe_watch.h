// SPDX-License-Identifier: Apache-2.0
// Whether a scan that began well still shows what it has to show. An object may leave the laser
// plane for some steps, or show itself twice in them; a laser that has gone out, daylight, and a
// second laser take the rest of the turn.
#pragma once

#include <algorithm>
#include <vector>

#include "acquisition/profile/judge.h"

namespace vitrine {

class StripeWatch {
 public:
  // `accepted`: nothing is told before so many steps are done.
  StripeWatch(int steps_of_a_turn, int accepted)
      : most_(static_cast<std::size_t>(std::max(steps_of_a_turn / 8, 3))), accepted_(accepted) {}

  // Of the next step, the `steps_done`-th. Fails (kBadInput) at the end of an eighth of a turn that
  // judge() refuses, be it not for what is saturated: that is told once, who goes on has accepted
  // it. A stripe that is found and lost again is told again; else, what comes again after an eighth
  // of a turn of which nothing was to be said: an object may hover about the limit.
  Expected<void> add(const StripeCount& stripe, int steps_done);

  // How many steps it judges, and refuses.
  int span() const { return static_cast<int>(most_); }

 private:
  const std::size_t most_;
  const int accepted_;
  std::vector<StripeCount> last_;
  std::size_t good_ = 0;                   // judgements in a row
  bool is_lost_ = false, is_odd_ = false;  // and has been told
};

}  // namespace vitrine
