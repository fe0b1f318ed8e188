// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "codec/progressive/manifest.h"
#include "codec/progressive/planner.h"

namespace vitrine::bench {

// From beside the model, to the right (1) or left (-1), to a hundredth of a pixel.
View side_view(const Manifest& manifest, double side);

}  // namespace vitrine::bench
