// SPDX-License-Identifier: Apache-2.0
// Computes profiles from frames, and the mesh from profiles, with the modules profile and surface.
#pragma once

#include <span>

#include "acquisition/calibration/calibration.h"
#include "acquisition/profile/judge.h"
#include "acquisition/profile/profile_of.h"
#include "acquisition/profile/sampling.h"
#include "acquisition/profile/stripe.h"
#include "acquisition/session/live_scanner.h"
#include "acquisition/surface/surface_of.h"

namespace vitrine::acquisition {

struct Processing {
  StripeOptions stripe;
  SamplingOptions sampling;
  // Options of the mesh. Two members are ignored: the noise comes from the calibration, the
  // sampling from `sampling`.
  SurfaceOptions surface;
};

struct Measured {
  Profile profile;
  StripeCount stripe;
};

// Computes the profile of one position of the table. `angle` is the angle, in degrees, by which the
// motor board has turned the table. Fails with kBadInput if the frames differ in size.
Expected<Measured> measure_profile(const FramePair& frames, const Calibration& calibration,
                                   const StripeOptions& options, double angle);

// Makes the mesh from measured profiles.
Expected<ScannedSurface> mesh_of(std::span<const Profile> profiles, const Calibration& calibration,
                                 const Processing& processing);

}  // namespace vitrine::acquisition
