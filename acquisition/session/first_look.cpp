// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/first_look.h"

namespace vitrine {

Expected<void> FirstLook::add(const FramePair& frames, double angle) {
  const auto stripe = find_stripe(frames.lit, frames.dark, options_);
  if (!stripe) return tl::unexpected(stripe.error());
  stripe_ = stripe_ + count(*stripe);
  profiles_.push_back(profile_of(*stripe, calibration_, angle));
  return {};
}

Expected<void> FirstLook::judgement() const {
  if (auto shown = judge(stripe_); !shown) return shown;
  return judge(profiles_);
}

}  // namespace vitrine
