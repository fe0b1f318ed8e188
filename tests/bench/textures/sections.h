// SPDX-License-Identifier: Apache-2.0
// The sections of the benchmark, one source file each.
#pragma once

#include <vector>

#include "bench/codec/report.h"
#include "textured_model.h"

namespace vitrine::bench {

// Makes three comparisons of sizes. Texture coordinates are compared with those in Draco files.
// Positions are compared with those of the same model without texture. Whole files are compared
// with Draco files that have unmasked pictures.
void sizes(Report& report, const std::vector<TexturedModel>& models);

// Compares the bytes after which the streamed model looks like the source with the bytes that a
// ladder of separate files (discrete_ladder.h) needs for the same similarity.
void appearance(Report& report, const TexturedModel& model);

}  // namespace vitrine::bench
