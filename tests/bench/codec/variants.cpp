// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sections.h"
#include "single_files.h"
#include "subject.h"

namespace vitrine::bench {
namespace {

constexpr double kFewest = 0.01, kMost = 0.5;  // of the default's faces
constexpr int kSteps = 8;

struct Variant {
  const char* name;
  Placement placement;
  CollapseOrder order;
};
constexpr Variant kVariants[] = {
    {"midpoint-heap", Placement::kMidpoint, CollapseOrder::kHeap},
    {"pyramid-batch", Placement::kPyramid, CollapseOrder::kBatch},
    {"pyramid-heap", Placement::kPyramid, CollapseOrder::kHeap},
};

// rms in % of the diagonal, over faces and over bytes.
struct Curves {
  std::vector<RatePoint> by_faces, by_bytes;
};

Curves measure_levels(const Model& model, Placement placement, CollapseOrder order) {
  Curves out;
  for (const Level& level : decode_levels(build(model.file, kBits, placement, order))) {
    const double error = rms_percent(level.mesh, model.clean);
    out.by_faces.push_back({static_cast<double>(level.mesh.faces.size()), error});
    out.by_bytes.push_back({static_cast<double>(level.bytes), error});
  }
  return out;
}

double error_at(const std::vector<RatePoint>& levels, double x) {
  std::size_t i = 1;
  while (i + 1 < levels.size() && levels[i].bytes < x)
    ++i;
  const RatePoint &a = levels[i - 1], &b = levels[i];
  const double t = std::log(x / a.bytes) / std::log(b.bytes / a.bytes);
  return a.error * std::pow(b.error / a.error, t);
}

// Geometric mean of the ratio of errors, evenly over the logarithm of faces or bytes, from where
// both have a level on.
double mean_ratio(const std::vector<RatePoint>& levels, const std::vector<RatePoint>& standard) {
  const double finest = standard.back().bytes * kMost;
  const double coarsest =
      std::max({standard.back().bytes * kFewest, standard.front().bytes, levels.front().bytes});
  double log_sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = coarsest * std::pow(finest / coarsest, i / (kSteps - 1.0));
    log_sum += std::log(error_at(levels, x) / error_at(standard, x));
  }
  return std::exp(log_sum / kSteps);
}

}  // namespace

void variants(Report& report, const Model& model) {
  const Curves standard = measure_levels(model, Placement::kMidpoint, CollapseOrder::kBatch);
  for (const Variant& variant : kVariants) {
    const Curves curves = measure_levels(model, variant.placement, variant.order);
    const std::string what = "variant." + model.name + '.' + variant.name;
    const double faces = mean_ratio(curves.by_faces, standard.by_faces);
    const double bytes = mean_ratio(curves.by_bytes, standard.by_bytes);
    const double total = curves.by_bytes.back().bytes, usual = standard.by_bytes.back().bytes;
    report.add({what, "error_at_equal_faces", 0, 0, faces, kNoThreshold});
    report.add({what, "error_at_equal_bytes", 0, 0, bytes, kNoThreshold});
    report.add({what, "total_bytes", total, usual, total / usual, kNoThreshold});
  }
}

}  // namespace vitrine::bench
