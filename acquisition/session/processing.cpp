// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/processing.h"

namespace vitrine {

Expected<Profile> measure_profile(const FramePair& frames, const Calibration& calibration,
                                  const StripeOptions& options, double angle) {
  const auto stripe = find_stripe(frames.lit, frames.dark, options);
  if (!stripe) return tl::unexpected(stripe.error());
  return profile_of(*stripe, calibration, angle);
}

Expected<ScannedSurface> mesh_of(std::span<const Profile> profiles, const Calibration& calibration,
                                 const Processing& processing) {
  SurfaceOptions options = processing.surface;
  options.sampling = processing.sampling;
  options.noise = options.sampling.noise = calibration.noise;
  return surface_of(profiles, options);
}

}  // namespace vitrine
