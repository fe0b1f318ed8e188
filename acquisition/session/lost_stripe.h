// SPDX-License-Identifier: Apache-2.0
// Whether a scan that had a stripe still has one. An object may leave the laser plane for some
// steps; a laser that has gone out, or daylight, takes the rest of the turn.
#pragma once

#include <algorithm>

#include "acquisition/profile/judge.h"

namespace vitrine {

class LostStripe {
 public:
  // `is_accepted`: it was lost before and the operator went on.
  LostStripe(int steps_of_a_turn, bool is_accepted)
      : most_(std::max(steps_of_a_turn / 8, 3)), lost_(is_accepted ? most_ : 0) {}

  // Of the next step, the `steps_done`-th. Fails (kBadInput) at the end of an eighth of a turn
  // without stripe.
  Expected<void> add(const StripeCount& stripe, int steps_done);

 private:
  const int most_;
  int lost_;  // steps in a row
  StripeCount sum_;
};

}  // namespace vitrine
