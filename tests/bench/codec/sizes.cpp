// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "sections.h"
#include "subject.h"

namespace vitrine::bench {
namespace {

constexpr double kMaxSize = 1.27, kMaxMeanSize = 1.03;
constexpr std::size_t kMeanModels = 5;  // fewer tell about themselves alone

}  // namespace

void sizes(Report& report, const std::vector<Model>& models) {
  double log_sum = 0;
  for (const Model& model : models) {
    const auto ours = static_cast<double>(build(model.file, kBits).size());
    const auto peer = static_cast<double>(draco_encode(model.clean, kBits).size());
    log_sum += std::log(ours / peer);
    report.add({"size." + model.name, "ratio_to_draco", ours, peer, ours / peer, kMaxSize});
  }
  const double mean = std::exp(log_sum / static_cast<double>(models.size()));
  report.add({"size.geometric_mean", "ratio_to_draco", 0, 0, mean,
              models.size() < kMeanModels ? kNoThreshold : kMaxMeanSize});
}

}  // namespace vitrine::bench
