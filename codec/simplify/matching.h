// SPDX-License-Identifier: Apache-2.0
// Chooses the collapses of one level: the cheapest legal edges with disjoint end points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/progressive/manifest.h"
#include "codec/simplify/apply_collapse.h"
#include "codec/simplify/closeness.h"
#include "codec/simplify/collapse_rules.h"
#include "codec/simplify/radix_sort.h"
#include "codec/simplify/surface.h"

namespace vitrine {

struct LevelRules {
  Placement placement = Placement::kMidpoint;
  std::int32_t parity = 0;          // of the level, see placement.h
  bool by_region = false;           // collapses stay inside their region
  double length_weight = 0;         // of the squared edge length, against the planes of the edge
  bool regular = false;             // takes more of the edges and stays nearer to the surface
  std::uint32_t most = 0xFFFFFFFF;  // collapses at most
  Vec3i low, high;                  // v~ stays in this box, inclusive

  bool allow(const Vec3i& p) const {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
           p.z <= high.z;
  }
};

class Matcher {
 public:
  explicit Matcher(const Surface& surface) : surface_(surface) {}

  // In ascending lexicographic order of target, no two the same. Costs ascend in the order of
  // choice, in steps of an eighth; within one, smaller vertex ids come first. A chosen edge keeps
  // its neighbours in other regions (by_region) or all of its neighbours (pyramid placement) from
  // collapsing in this level.
  const std::vector<Pick>& match(const LevelRules& rules);

  // True if the collapse turns no face over and stays as near to the surface as the rules of the
  // last match() ask for. Collapses that come before it in the level may change the answer.
  bool keeps_shape(const EdgeStar& edge, const Vec3i& target) const {
    return keeps_orientation(surface_, edge, target) && keeps_near(surface_, edge, target, reach_);
  }

 private:
  void sum_rings();
  void list_edges(const LevelRules& rules);
  Vec3 likely_target(const LevelRules& rules, Corner c) const;
  // In the order given, until `enough` are picked.
  void choose(const LevelRules& rules, std::span<const KeyedIndex> edges, std::size_t enough);
  void choose(const LevelRules& rules, Corner c);
  void withhold_neighbours(const LevelRules& rules, const EdgeStar& edge);

  const Surface& surface_;
  std::vector<KeyedIndex> edges_, scratch_;  // key: bits of the cost as float; index: a corner
  std::vector<std::uint8_t> taken_;          // per vertex
  std::vector<Vec3> ring_sum_;               // per vertex: of its real neighbours
  std::vector<std::uint32_t> ring_size_;
  double mean_edge_ = 0, reach_ = 0;  // reach_: of keeps_near()
  std::vector<Pick> picks_;
};

}  // namespace vitrine
