// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "error_curves.h"
#include "sections.h"
#include "subject.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

// Range in which errors are compared, as shares of the faces or bytes of the default variant's
// finest level.
constexpr double kSmallest = 0.01, kLargest = 0.5;
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

ErrorCurves measure_levels(const BenchmarkModel& model, Placement placement, CollapseOrder order) {
  return error_curves(build(model.file, kBits, placement, order), model.clean);
}

// Returns the error of `levels` divided by that of `standard`, at equal faces or equal bytes. Takes
// the geometric mean over the range in which both curves have levels, at points evenly spaced on a
// logarithmic scale.
double mean_ratio(const std::vector<ErrorPoint>& levels, const std::vector<ErrorPoint>& standard) {
  const double finest = standard.back().x * kLargest;
  const double coarsest =
      std::max({standard.back().x * kSmallest, standard.front().x, levels.front().x});
  double log_sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = coarsest * std::pow(finest / coarsest, i / (kSteps - 1.0));
    log_sum += std::log(error_at(levels, x) / error_at(standard, x));
  }
  return std::exp(log_sum / kSteps);
}

}  // namespace

void variants(Report& report, const BenchmarkModel& model) {
  const ErrorCurves standard = measure_levels(model, Placement::kMidpoint, CollapseOrder::kBatch);
  for (const Variant& variant : kVariants) {
    const ErrorCurves curves = measure_levels(model, variant.placement, variant.order);
    const std::string what = "variant." + model.name + '.' + variant.name;
    const double faces = mean_ratio(curves.by_faces, standard.by_faces);
    const double bytes = mean_ratio(curves.by_bytes, standard.by_bytes);
    const double total = curves.by_bytes.back().x, usual = standard.by_bytes.back().x;
    report.add({what, "error_at_equal_faces", 0, 0, faces, kNoThreshold});
    report.add({what, "error_at_equal_bytes", 0, 0, bytes, kNoThreshold});
    report.add({what, "total_bytes", total, usual, total / usual, kNoThreshold});
  }
}

}  // namespace vitrine::bench
