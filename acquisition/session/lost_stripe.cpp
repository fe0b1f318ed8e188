// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/lost_stripe.h"

#include <fmt/format.h>

namespace vitrine {

Expected<void> LostStripe::add(const StripeCount& stripe, int steps_done) {
  if (shows_stripe(stripe)) {
    lost_ = 0;
    sum_ = {};
    return {};
  }
  sum_ = sum_ + stripe;
  if (++lost_ != most_) return {};
  return fail(
      ErrorCode::kBadInput,
      fmt::format("the stripe is lost since step {} of the scan, {}; then start a new scan, "
                  "or resume this one where the object just leaves the light",
                  steps_done - most_ + 1, judge(sum_).error().message));
}

}  // namespace vitrine
