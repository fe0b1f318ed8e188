// SPDX-License-Identifier: Apache-2.0
// Fits the display filter of each level and measures the level's error, in parallel with the
// encoding of further levels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <future>
#include <vector>

#include "codec/coding/mesh_state.h"
#include "codec/distance/error_meter.h"
#include "codec/format/manifest.h"
#include "codec/simplify/simplify.h"

namespace vitrine::inline codec {

class LevelErrors {
 public:
  // `original` is the mesh in model units before it was quantised for `hierarchy`. Measures up to
  // `threads` levels at the same time.
  LevelErrors(TriangleMesh original, const Hierarchy& hierarchy, unsigned threads);

  // Adds the next level. Levels must be added from coarse to fine. `is_last` marks full resolution,
  // which is displayed without a filter, as the original rounded to the lattice.
  void add(const MeshState& level, bool is_last);

  // Waits for all levels and writes their errors and filters to `manifest`.
  void finish(Manifest& manifest);

 private:
  struct Pending {
    std::future<LevelError> error;
    std::size_t weight;
  };

  std::size_t make_room(std::size_t faces);
  TriangleMesh displayed(const MeshState& level, double filter) const;
  std::vector<std::uint16_t> number_regions(std::uint32_t& count) const;
  LevelRegions regions_of(std::vector<std::uint16_t> leaves) const;
  void settle();

  ErrorMeter meter_;
  Lattice lattice_;
  RegionTree tree_;
  std::vector<std::uint16_t> leaf_;  // per vertex of the original: its leaf
  unsigned threads_;
  std::deque<Pending> pending_;
  std::size_t weight_ = 0;          // total weight of all pending levels
  std::vector<double> filters_;     // filter strength of each level
  std::vector<LevelError> errors_;  // error of each level whose measurement is complete
};

}  // namespace vitrine::inline codec
