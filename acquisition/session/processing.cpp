// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/processing.h"

#include <algorithm>

namespace vitrine {

Expected<Profile> measure_profile(const FramePair& frames, const Calibration& calibration,
                                  const StripeOptions& options, double angle) {
  const auto stripe = find_stripe(frames.lit, frames.dark, options);
  if (!stripe) return tl::unexpected(stripe.error());
  return profile_of(*stripe, calibration, angle);
}

Expected<Surface> mesh_of(std::vector<Profile> profiles, const Calibration& calibration,
                          const Processing& processing) {
  // A table may turn either way.
  std::ranges::sort(profiles, {}, &Profile::theta);
  SamplingOptions sampling = processing.sampling;
  sampling.noise = calibration.noise;
  for (Profile& profile : profiles)
    profile = sample(profile, sampling);
  return surface_of(profiles, processing.surface);
}

}  // namespace vitrine
