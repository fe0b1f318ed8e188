// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "codec/format/manifest.h"
#include "codec/plan/planner.h"

namespace vitrine::bench {

// Returns a view from the right side of the model (1) or the left (-1), with errors of at most a
// hundredth of a pixel.
View side_view(const Manifest& manifest, double side);

}  // namespace vitrine::bench
