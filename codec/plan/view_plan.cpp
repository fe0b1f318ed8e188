// SPDX-License-Identifier: Apache-2.0
#include "codec/plan/view_plan.h"

#include <algorithm>

namespace vitrine::inline codec {
namespace {

// Smallest gain of a chunk, as a share of the coarser level's error in pixels. This minimum keeps
// the gain positive if a level's error bound equals that of the coarser level. With a gain of 0,
// such a level would block all finer levels.
constexpr double kLeastGain = 0.01;

}  // namespace

ViewPlan::ViewPlan(const Manifest& manifest, const std::vector<std::uint8_t>& have,
                   const View& view)
    : manifest_(manifest),
      have_(have),
      view_(view),
      leaf_level_(manifest.tree.leaves(), 0),
      required_(have.size(), 0) {
  for (std::size_t i = 0; i < have.size(); ++i) {
    const ChunkInfo& chunk = manifest.chunks[i];
    if (!have[i] || leaf_level_[chunk.region] + 1 != chunk.level) continue;
    std::fill_n(leaf_level_.begin() + chunk.region, manifest.region(chunk).leaves, chunk.level);
  }
}

// Returns the number of pixels by which the chunk reduces the visible error. Returns 0 if that
// error is already within the target.
double ViewPlan::gain(std::size_t index) const {
  const ChunkInfo& chunk = manifest_.chunks[index];
  const std::size_t coarser = manifest_.find_chunk(chunk.level - 1, chunk.region);
  const double before = coarser < manifest_.chunks.size() ? manifest_.chunks[coarser].max_error
                                                          : manifest_.levels[0].max_error;
  const double pixels = pixels_of(before, manifest_.region(chunk).box, manifest_.lattice, view_);
  if (pixels <= view_.pixel_error) return 0;
  return pixels * std::max(1 - chunk.max_error / before, kLeastGain);
}

// Returns the chunk and its missing prerequisites, in an order in which they can be applied. The
// list is incomplete if the step limit was reached.
std::vector<std::size_t> ViewPlan::missing_for(std::size_t chunk) {
  ++call_;
  std::vector<std::size_t> missing;
  require(chunk, missing);
  return missing;
}

void ViewPlan::require(std::size_t index, std::vector<std::size_t>& missing) {
  required_[index] = call_;
  const ChunkInfo& chunk = manifest_.chunks[index];
  const auto need = [&](std::uint32_t leaf) {
    for (std::uint32_t level = leaf_level_[leaf] + 1; level < chunk.level && !is_exhausted();
         ++level) {
      ++steps_;
      const std::size_t coarser = manifest_.find_chunk(level, leaf);
      if (required_[coarser] != call_) require(coarser, missing);
    }
  };
  const RegionNode& region = manifest_.region(chunk);
  for (std::uint32_t leaf = region.first; leaf < region.first + region.leaves; ++leaf) {
    steps_ += manifest_.adjacency[leaf].size() + 1;
    for (const std::uint32_t next : manifest_.adjacency[leaf])
      need(next);
  }
  missing.push_back(index);
}

// Returns the first missing chunk of the file, or nullopt if this chunk is longer than `bytes`.
// Chunks are in order of levels, so the first missing chunk can always be applied.
std::optional<std::size_t> ViewPlan::first_missing(double bytes) const {
  const auto at =
      static_cast<std::size_t>(std::find(have_.begin(), have_.end(), 0) - have_.begin());
  if (static_cast<double>(manifest_.chunks[at].length) > bytes) return std::nullopt;
  return at;
}

std::optional<std::size_t> ViewPlan::best(double bytes) {
  std::optional<std::size_t> found;
  double most = 0;
  for (std::size_t i = 0; i < have_.size(); ++i) {
    const ChunkInfo& chunk = manifest_.chunks[i];
    if (have_[i] || leaf_level_[chunk.region] + 1 != chunk.level) continue;
    const double removed = gain(i);
    if (removed == 0) continue;
    const std::vector<std::size_t> missing = missing_for(i);
    if (is_exhausted()) return found ? found : first_missing(bytes);
    double length = 0;
    for (const std::size_t m : missing)
      length += static_cast<double>(manifest_.chunks[m].length);
    if (length > bytes || removed <= most * (length + 1)) continue;
    most = removed / (length + 1);
    found = missing[0];
  }
  return found;
}

}  // namespace vitrine::inline codec
