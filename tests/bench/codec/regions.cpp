// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>

#include "close_up.h"
#include "sections.h"
#include "subject.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

// Maximum size of a file, as a multiple of the size of the same file with one region.
constexpr double kMaxRegions = 1.03;
// Largest allowed download for a close-up, as a share of a large scan's file.
constexpr double kMaxCloseUp = 1.0 / 3;

struct CloseUp {
  const char* name;
  double share;  // share of the diagonal that fills the height of the viewport
  double limit;
};
// The closest views that are measured. In closer views, a pixel would hardly be larger than the
// rounding of the lattice, so all visible regions would need full resolution. Even in these views,
// a scan needs full resolution if only its last level has an error of at most one pixel.
constexpr CloseUp kCloseUps[] = {{"close_up_quarter", 0.25, kMaxCloseUp},
                                 {"close_up_eighth", 0.125, kNoThreshold}};

// Considers only chunks of levels with several regions. Returns the number of such chunks smaller
// than 8 KiB or larger than 64 KiB, and the number of all such chunks.
std::pair<double, double> chunks_out_of_band(const Manifest& manifest) {
  double outside = 0, all = 0;
  for (const ChunkInfo& chunk : manifest.chunks) {
    if (chunk.node == 0) continue;
    ++all;
    outside += chunk.length < (8u << 10) || chunk.length > (64u << 10) ? 1 : 0;
  }
  return {outside, all};
}

}  // namespace

void regions(Report& report, const BenchmarkModel& model) {
  const Bytes file = build(model.file, kBits);
  const Manifest manifest = *parse_header(file);
  if (manifest.tree.leaves() < 4) return;
  const auto whole = static_cast<double>(file.size());
  const auto one = static_cast<double>(build_in_one_region(model.file, kBits).size());
  report.add(
      {"regions." + model.name, "ratio_to_one_region", whole, one, whole / one, kMaxRegions});
  const auto [outside, all] = chunks_out_of_band(manifest);
  report.add(
      {"regions." + model.name, "chunks_out_of_8_to_64_KiB", outside, all, outside / all, 0});
  for (const CloseUp& close_up : kCloseUps) {
    double sum = 0;
    const std::vector<View> views = close_ups(model.clean, close_up.share);
    for (const View& view : views)
      sum += static_cast<double>(bytes_for(manifest, view));
    const double mean = sum / static_cast<double>(views.size());
    report.add({close_up.name + ("." + model.name), "ratio_to_whole", mean, whole, mean / whole,
                is_large(model) ? close_up.limit : kNoThreshold});
  }
}

}  // namespace vitrine::bench
