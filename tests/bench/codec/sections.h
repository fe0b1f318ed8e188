// SPDX-License-Identifier: Apache-2.0
// The sections of the benchmark, one source file each.
#pragma once

#include <vector>

#include "models.h"
#include "report.h"
#include "support/product_names.h"

namespace vitrine::bench {

inline constexpr int kBits = 12;  // lattice bits per coordinate in every comparison

// Compares the sizes of whole files with those of Draco's files.
void sizes(Report& report, const std::vector<BenchmarkModel>& models);

// Compares the bytes of each level with those of the single file of equal error (single_files.h),
// for levels with 1 % to 50 % of the faces. Skips models with colours and models of fewer than
// 50,000 faces.
void rate_distortion(Report& report, const std::vector<BenchmarkModel>& models);

// Compares the default way to simplify (Placement::kMidpoint, CollapseOrder::kBatch) with the three
// other combinations of Placement and CollapseOrder. Reports the error at equal numbers of faces,
// the error at equal numbers of bytes, and the total bytes.
void variants(Report& report, const BenchmarkModel& model);

// Simplifies to a tenth of the faces with other libraries, whose positions are not rounded.
// Compares their rms error with the error of our displayed level (rounded to the lattice) at the
// same number of faces. Compares their time with the time of one build, which makes every level and
// the file.
void simplifiers(Report& report, const BenchmarkModel& model);

// Measures the cost of regions, and the share of the file that a close-up needs. Skips models with
// fewer than four regions.
void regions(Report& report, const BenchmarkModel& model);

// Compares our decode time with Draco's, and WebAssembly with native code.
void speeds(Report& report, const BenchmarkModel& model);

// Compares our build time with meshoptimizer's, and the build time on two threads with that on one.
// Measures how time and memory grow up to the largest model.
void builds(Report& report, const BenchmarkModel& model, const BenchmarkModel& largest);

}  // namespace vitrine::bench
