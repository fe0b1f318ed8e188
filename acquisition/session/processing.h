// SPDX-License-Identifier: Apache-2.0
// From frames to the mesh, as the rooms below do it one after the other.
#pragma once

#include <span>

#include "acquisition/calibration/calibration.h"
#include "acquisition/profile/judge.h"
#include "acquisition/profile/profile_of.h"
#include "acquisition/profile/sampling.h"
#include "acquisition/profile/stripe.h"
#include "acquisition/session/live_scanner.h"
#include "acquisition/surface/surface_of.h"

namespace vitrine {

struct Processing {
  StripeOptions stripe;
  SamplingOptions sampling;
  SurfaceOptions surface;  // but for noise and sampling, which come from elsewhere
};

struct Measured {
  Profile profile;
  StripeCount stripe;
};

// Of one position of the table, which the board has turned by `angle` degrees. Fails (kBadInput)
// where the frames differ in size.
Expected<Measured> measure_profile(const FramePair& frames, const Calibration& calibration,
                                   const StripeOptions& options, double angle);

// Profiles as measured to the mesh.
Expected<ScannedSurface> mesh_of(std::span<const Profile> profiles, const Calibration& calibration,
                                 const Processing& processing);

}  // namespace vitrine
