// SPDX-License-Identifier: Apache-2.0
// Chooses the collapses of one level: the cheapest legal edges, no two of which share a vertex.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/format/manifest.h"
#include "codec/simplify/apply_collapse.h"
#include "codec/simplify/closeness.h"
#include "codec/simplify/collapse_rules.h"
#include "codec/simplify/radix_sort.h"
#include "codec/simplify/surface.h"

namespace vitrine::inline codec {

struct LevelRules {
  Placement placement = Placement::kMidpoint;
  std::int32_t parity = 0;     // parity of the level (placement.h)
  bool keeps_regions = false;  // whether collapses must stay inside one region
  // Weight of the squared edge length in the cost. The mean squared distance from the planes has
  // weight 1.
  double length_weight = 0;
  // Whether the level allows more collapses but demands that they stay closer to the surface.
  bool is_regular = false;
  std::uint32_t most = 0xFFFFFFFF;  // maximum number of collapses
  Vec3i low, high;                  // v~ must lie in this box; both corners belong to it

  bool allows(const Vec3i& p) const {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
           p.z <= high.z;
  }
};

class CollapseMatcher {
 public:
  explicit CollapseMatcher(const Surface& surface) : surface_(surface) {}

  // Chooses the collapses of a level. Returns them in ascending lexicographic order of their
  // targets, without duplicate targets. Cheaper edges are chosen first. Costs within the same
  // eighth of an octave count as equal; edges of equal cost are chosen in ascending order of their
  // smaller vertex. Once an edge is chosen, some neighbours of its ends cannot collapse in this
  // level: those in other regions if `keeps_regions` is set, all of them with pyramid placement.
  const std::vector<Pick>& match(const LevelRules& rules);

  // Whether the collapse turns no face over and stays as close to the surface as the rules of the
  // last match() require. Earlier collapses of the level may change the result.
  bool keeps_shape(const EdgeStar& edge, const Vec3i& target) const {
    return keeps_orientation(surface_, edge, target) && keeps_near(surface_, edge, target, reach_);
  }

 private:
  void sum_rings();
  void list_edges(const LevelRules& rules);
  Vec3 likely_target(const LevelRules& rules, Corner c) const;
  // Tries edges in the given order until `enough` collapses are chosen.
  void choose(const LevelRules& rules, std::span<const KeyedIndex> edges, std::size_t enough);
  void choose(const LevelRules& rules, Corner c);
  void withhold_neighbours(const LevelRules& rules, const EdgeStar& edge);

  const Surface& surface_;
  // Key: leading bits of the cost as a float; index: a corner.
  std::vector<KeyedIndex> edges_, scratch_;
  // Per vertex: whether it can no longer collapse in this level.
  std::vector<std::uint8_t> is_taken_;
  // Per vertex: sum of the positions of its neighbours that are not virtual.
  std::vector<Vec3> ring_sum_;
  std::vector<std::uint32_t> ring_size_;
  double mean_edge_ = 0, reach_ = 0;  // reach_: the limit for keeps_near()
  std::vector<Pick> picks_;
};

}  // namespace vitrine::inline codec
