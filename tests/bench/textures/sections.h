// SPDX-License-Identifier: Apache-2.0
// The sections of the benchmark, one source file each.
#pragma once

#include <vector>

#include "bench/codec/report.h"
#include "textured_model.h"

namespace vitrine::bench {

// Compares sizes: of texture coordinates with those of Draco, of positions with those of the same
// model without texture, and of whole files with Draco's and unmasked pictures.
void sizes(Report& report, const std::vector<TexturedModel>& models);

// Compares the bytes at which the model looks like the source with those of a ladder of separate
// files (discrete_ladder.h).
void appearance(Report& report, const TexturedModel& model);

}  // namespace vitrine::bench
