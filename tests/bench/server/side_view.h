// SPDX-License-Identifier: Apache-2.0
// Views of a model from its sides, between which a benchmark's viewers turn.
#pragma once

#include "codec/format/manifest.h"
#include "codec/plan/planner.h"

namespace vitrine::bench {

// Returns a view from the model's right (1) or left (-1) side. The view allows errors of at most a
// hundredth of a pixel.
View side_view(const Manifest& manifest, double side);

}  // namespace vitrine::bench
