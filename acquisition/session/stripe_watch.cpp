// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/stripe_watch.h"

#include <fmt/format.h>

#include <utility>

namespace vitrine::acquisition {

Expected<void> StripeWatch::add(const StripeCount& stripe, int steps_done) {
  last_.push_back(stripe);
  if (last_.size() > most_) last_.erase(last_.begin());
  StripeCount seen = sum(last_);
  // Ignores saturation, because one side of an object may be brighter than its other sides.
  seen.saturated = 0;
  const bool is_lost = !shows_stripe(seen);
  if (!is_lost) is_lost_ = false;
  const auto judged = judge(seen);
  good_ = judged ? good_ + 1 : 0;
  if (good_ == most_) is_odd_ = false;
  if (judged || last_.size() < most_ || std::exchange(is_lost ? is_lost_ : is_odd_, true) ||
      steps_done <= accepted_)
    return {};
  return fail(
      ErrorCode::kBadInput,
      fmt::format("the stripe {} since step {} of the scan, {}, then start a new scan, "
                  "or resume this one: it measures again from there, and accepts an object that {}",
                  is_lost ? "is lost" : "has changed", steps_done - static_cast<int>(most_) + 1,
                  judged.error().message, is_lost ? "leaves the laser plane" : "looks like that"));
}

}  // namespace vitrine::acquisition
