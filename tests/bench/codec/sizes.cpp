// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <stdexcept>

#include "codec/format/manifest.h"
#include "sections.h"
#include "subject.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

constexpr double kMaxSize = 1.27, kMaxMeanSize = 1.03;
// Minimum number of models for which a mean is meaningful.
constexpr std::size_t kMeanModels = 5;
// Maximum bytes of a file's head (header and base mesh) per million triangles. The first request
// fetches the head. The number of millions is rounded up.
constexpr double kMaxHead = 32 * 1024;

void first_request(Report& report, const BenchmarkModel& model, const Bytes& pmesh) {
  const auto manifest = parse_header(pmesh);
  if (!manifest) throw std::runtime_error(manifest.error().message);
  const auto bytes = static_cast<double>(manifest->head_bytes());
  const double millions = std::ceil(static_cast<double>(model.clean.faces.size()) / 1e6);
  report.add(
      {"head." + model.name, "bytes_per_million_triangles", bytes, 0, bytes / millions, kMaxHead});
}

}  // namespace

void sizes(Report& report, const std::vector<BenchmarkModel>& models) {
  double log_sum = 0;
  for (const BenchmarkModel& model : models) {
    const Bytes pmesh = build(model.file, kBits);
    const auto ours = static_cast<double>(pmesh.size());
    const auto peer = static_cast<double>(draco_encode(model.clean, kBits).size());
    log_sum += std::log(ours / peer);
    report.add({"size." + model.name, "ratio_to_draco", ours, peer, ours / peer, kMaxSize});
    first_request(report, model, pmesh);
  }
  const double mean = std::exp(log_sum / static_cast<double>(models.size()));
  report.add({"size.geometric_mean", "ratio_to_draco", 0, 0, mean,
              models.size() < kMeanModels ? kNoThreshold : kMaxMeanSize});
}

}  // namespace vitrine::bench
