// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>

#include "sections.h"
#include "single_files.h"
#include "subject.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

// Maximum ratio of a level's bytes to the bytes of a single file with equal error. The limit
// applies to the geometric mean over a model's levels.
constexpr double kMaxRate = 1.5;
constexpr std::size_t kFewestFaces = 50'000;
// Range of the compared levels, as shares of the original's faces.
constexpr double kCoarsest = 0.01, kFinest = 0.5;

void compare(Report& report, const BenchmarkModel& model, const RateCurve& peer) {
  const auto all = static_cast<double>(model.clean.faces.size());
  double log_sum = 0;
  int levels = 0;
  for (const Level& level : decode_levels(build(model.file, kBits))) {
    const double share = static_cast<double>(level.mesh.faces.size()) / all;
    if (share < kCoarsest || share > kFinest) continue;
    const auto peer_bytes = peer.bytes_at(rms_percent(level.mesh, model.clean));
    if (!peer_bytes) continue;
    const double ours = static_cast<double>(level.bytes), theirs = *peer_bytes;
    char name[64];
    std::snprintf(name, sizeof name, "rate.%s.%04.1f%%", model.name.c_str(), 100 * share);
    report.add(
        {name, "ratio_to_single_file", ours, std::round(theirs), ours / theirs, kNoThreshold});
    log_sum += std::log(ours / theirs), ++levels;
  }
  const double mean = std::exp(log_sum / levels);
  report.add({"rate." + model.name + ".mean", "ratio_to_single_file", 0, 0, mean, kMaxRate});
}

}  // namespace

void rate_distortion(Report& report, const std::vector<BenchmarkModel>& models) {
  for (const BenchmarkModel& model : models) {
    if (model.clean.faces.size() < kFewestFaces || !model.clean.attributes.colours.empty())
      continue;
    compare(report, model, single_files(model.clean));
  }
}

}  // namespace vitrine::bench
