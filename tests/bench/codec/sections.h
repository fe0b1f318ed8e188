// SPDX-License-Identifier: Apache-2.0
// What the benchmark compares, one section a file.
#pragma once

#include <vector>

#include "models.h"
#include "report.h"

namespace vitrine::bench {

inline constexpr int kBits = 12;  // of every comparison

// Bytes of whole files against Draco's.
void sizes(Report& report, const std::vector<Model>& models);

// Bytes of each level between 1 % and 50 % of the faces against the single file of equal error
// (single_files.h), for the models without colours that are large enough to have such levels.
void rate_distortion(Report& report, const std::vector<Model>& models);

// The three other variants of pyramid or midpoint placement and heap or batch order against the
// default: error at equal faces, at equal bytes, and total bytes.
void variants(Report& report, const Model& model);

// A tenth of the faces by other libraries' simplifiers, whose positions are not rounded: against
// their rms that of our levels as displayed at the same number of faces, lattice included; against
// their time that of one build, which makes every level and the file.
void simplifiers(Report& report, const Model& model);

// What regions cost, and what a close-up needs of the whole; of models with several of them.
void regions(Report& report, const Model& model);

// Decode time against Draco's, WebAssembly against native.
void speeds(Report& report, const Model& model);

// Build times against meshoptimizer's, and how time and memory grow up to the largest model.
void builds(Report& report, const Model& model, const Model& largest);

}  // namespace vitrine::bench
