// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/first_look.h"

#include <utility>

namespace vitrine::acquisition {

Expected<void> FirstLook::add(const FramePair& frames, double angle) {
  auto measured = measure_profile(frames, calibration_, options_, angle);
  if (!measured) return tl::unexpected(measured.error());
  stripe_ = stripe_ + measured->stripe;
  profiles_.push_back(std::move(measured->profile));
  return {};
}

Expected<void> FirstLook::judgement() const {
  if (auto shown = judge(stripe_); !shown) return shown;
  return judge(profiles_);
}

}  // namespace vitrine::acquisition
