// SPDX-License-Identifier: Apache-2.0
// Fits the display filter of each level and measures the level's error. Runs in parallel with the
// encoding of later levels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "codec/coding/mesh_state.h"
#include "codec/core/task_queue.h"
#include "codec/distance/error_meter.h"
#include "codec/format/manifest.h"
#include "codec/simplify/simplify.h"

namespace vitrine::inline codec {

class LevelErrors {
 public:
  // `original` is the mesh from which `hierarchy` was built, before quantisation and in model
  // units. Uses at most `threads` (>= 1) threads, one of which is the caller's.
  LevelErrors(TriangleMesh original, const Hierarchy& hierarchy, unsigned threads);

  // Adds the next level. Levels must be added from coarse to fine. `is_last` marks full resolution.
  // It is displayed without a filter, because it is the original rounded to the lattice.
  void add(const MeshState& level, bool is_last);

  // Waits for all levels and writes their errors and filters to `manifest`.
  void finish(Manifest& manifest);

 private:
  std::size_t weight_of(std::size_t faces) const;
  TriangleMesh displayed(const MeshState& level, double filter) const;
  std::vector<std::uint16_t> number_regions(std::uint32_t& count) const;
  LevelRegions regions_of(std::vector<std::uint16_t> leaves) const;

  ErrorMeter meter_;
  Lattice lattice_;
  RegionTree tree_;
  std::vector<std::uint16_t> leaf_;  // region tree leaf of each vertex of the original
  std::vector<double> filters_;      // per level: strength of the display filter
  std::deque<LevelError> errors_;    // per level: its error, once measured
  TaskQueue queue_;                  // measures the levels
};

}  // namespace vitrine::inline codec
