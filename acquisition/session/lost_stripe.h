// SPDX-License-Identifier: Apache-2.0
// Whether a scan that had a stripe still has one. An object may leave the laser plane for some
// steps; a laser that has gone out, or daylight, takes the rest of the turn.
#pragma once

#include <algorithm>

#include "acquisition/profile/judge.h"

namespace vitrine {

class LostStripe {
 public:
  explicit LostStripe(int steps_of_a_turn) : most_(std::max(steps_of_a_turn / 8, 3)) {}

  // Of the next step, the `steps_done`-th. Fails (kBadInput) once at the end of an eighth of a turn
  // without stripe: who goes on has accepted it.
  Expected<void> add(const StripeCount& stripe, int steps_done);

 private:
  const int most_;
  int lost_ = 0;  // steps in a row
  StripeCount sum_;
};

}  // namespace vitrine
