// SPDX-License-Identifier: Apache-2.0
// The display filters and errors of a model's levels, measured while the next levels are coded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <future>
#include <vector>

#include "codec/progressive/manifest.h"
#include "codec/progressive/mesh_state.h"
#include "codec/simplify/error_meter.h"
#include "codec/simplify/simplify.h"

namespace vitrine {

class LevelErrors {
 public:
  // `original`: as it was quantised into the hierarchy, in model units. Levels are measured
  // `threads` at a time.
  LevelErrors(TriangleMesh original, const Hierarchy& hierarchy, unsigned threads);

  // Levels come coarse to fine. `last`: full resolution is shown as it is, the original rounded to
  // the lattice.
  void add(const MeshState& level, bool last);

  // Waits for all levels and enters what they showed.
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
  std::vector<std::uint16_t> leaf_;  // per vertex of the original
  unsigned threads_;
  std::deque<Pending> pending_;
  std::size_t weight_ = 0;          // of all pending
  std::vector<double> filters_;     // per level
  std::vector<LevelError> errors_;  // per settled level
};

}  // namespace vitrine
