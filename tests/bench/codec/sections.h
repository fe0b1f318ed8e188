// SPDX-License-Identifier: Apache-2.0
// The sections of the benchmark, one source file each.
#pragma once

#include <vector>

#include "models.h"
#include "report.h"
#include "support/product_names.h"

namespace vitrine::bench {

inline constexpr int kBits = 12;  // lattice bits per coordinate in every comparison

// Compares the sizes of whole files with Draco's.
void sizes(Report& report, const std::vector<BenchmarkModel>& models);

// Compares the bytes of each level between 1 % and 50 % of the faces with the single file of equal
// error (single_files.h). Skips models with colours and models of fewer than 50,000 faces.
void rate_distortion(Report& report, const std::vector<BenchmarkModel>& models);

// Compares the default variant (midpoint placement, batch order) with the three other combinations
// of placement and order: error at equal faces, error at equal bytes, and total bytes.
void variants(Report& report, const BenchmarkModel& model);

// Simplifies with other libraries to a tenth of the faces, without rounded positions. Compares
// their rms error with that of our displayed levels (lattice included) at the same number of faces.
// Compares their time with that of one build, which makes every level and the file.
void simplifiers(Report& report, const BenchmarkModel& model);

// Measures the cost of regions, and the share of the file that a close-up needs. Skips models with
// fewer than four regions.
void regions(Report& report, const BenchmarkModel& model);

// Compares decode time with Draco's, and WebAssembly with native code.
void speeds(Report& report, const BenchmarkModel& model);

// Compares build times with meshoptimizer's. Measures how time and memory grow up to the largest
// model.
void builds(Report& report, const BenchmarkModel& model, const BenchmarkModel& largest);

}  // namespace vitrine::bench
