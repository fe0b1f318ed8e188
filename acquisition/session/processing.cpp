// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/processing.h"

namespace vitrine::acquisition {

Expected<Measured> measure_profile(const FramePair& frames, const Calibration& calibration,
                                   const StripeOptions& options, double angle) {
  const auto stripe = find_stripe(frames.lit, frames.dark, options);
  if (!stripe) return tl::unexpected(stripe.error());
  return Measured{profile_of(*stripe, calibration, angle),
                  count(*stripe) + count_full(frames.lit) + count_full(frames.dark)};
}

Expected<ScannedSurface> mesh_of(std::span<const Profile> profiles, const Calibration& calibration,
                                 const Processing& processing) {
  SurfaceOptions options = processing.surface;
  options.sampling = processing.sampling;
  // Only the smoothing needs the calibrated noise. options.sampling.noise is left at its default,
  // because surface_of() smooths the points before it samples them.
  options.noise = calibration.noise;
  return surface_of(profiles, options);
}

}  // namespace vitrine::acquisition
