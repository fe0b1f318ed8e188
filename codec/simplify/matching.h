// SPDX-License-Identifier: Apache-2.0
// Chooses the collapses of one level: the cheapest legal edges such that no two share a vertex.
#pragma once

#include <cstdint>
#include <optional>
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
  // the weight 1.
  double length_weight = 0;
  // Whether the level may have more collapses (kCheapRegular instead of kCheap), which must stay
  // closer to the surface (kReachRegular instead of kReach).
  bool is_regular = false;
  std::uint32_t most = 0xFFFFFFFF;  // maximum number of collapses
  Vec3i low, high;                  // merged vertices must lie in this box, corners included

  bool allows(const Vec3i& p) const {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
           p.z <= high.z;
  }
};

class CollapseMatcher {
 public:
  // Checks edges on at most `threads` (>= 1) threads, which does not change the result.
  CollapseMatcher(const Surface& surface, unsigned threads)
      : surface_(surface), threads_(threads) {}

  // Chooses the collapses of a level, cheapest edges first. Costs within the same eighth of an
  // octave (a factor of 2) count as equal. Edges of equal cost are chosen in ascending order of
  // their smaller vertex. Returns the collapses in ascending lexicographic order of their targets,
  // without duplicate targets.
  //
  // After an edge is chosen, some neighbours of its ends cannot collapse in this level: all
  // neighbours if the level's placement is kPyramid; otherwise, if `keeps_regions` is set, the
  // neighbours in other regions.
  const std::vector<Pick>& match(const LevelRules& rules);

  // Whether the collapse turns no face over and keeps the surface as close as the rules of the last
  // match() require. Earlier collapses of the level may have changed the result.
  bool keeps_shape(const EdgeStar& edge, const Vec3i& target) const {
    return keeps_orientation(surface_, edge, target) && keeps_near(surface_, edge, target, reach_);
  }

 private:
  void sum_rings();
  void list_edges(const LevelRules& rules);
  // The edges of some live vertices. Each edge is listed once, at its vertex with the smaller ID.
  struct EdgeList;
  EdgeList edges_at(const LevelRules& rules, std::span<const VertexId> live) const;
  Vec3 likely_target(const LevelRules& rules, Corner c) const;
  // Tries the edges in the given order until `enough` collapses are chosen.
  void choose(const LevelRules& rules, std::span<const KeyedIndex> edges, std::size_t enough);
  // Returns the position of the merged vertex if the edge at `c` collapses, or nullopt if the edge
  // must not collapse now.
  std::optional<Vec3i> check(const LevelRules& rules, Corner c) const;
  bool is_taken(Corner c) const {
    return is_taken_[surface_.mesh.vertex(c)] != 0 || is_taken_[surface_.mesh.neighbour(c)] != 0;
  }
  void take(const LevelRules& rules, const Pick& pick);
  void withhold_neighbours(const LevelRules& rules, VertexId v);

  const Surface& surface_;
  unsigned threads_;
  // Edges that may collapse, to be sorted by cost. Key: leading bits of the cost as a float. Index:
  // the corner that identifies the edge. `scratch_` is for radix_sort().
  std::vector<KeyedIndex> edges_, scratch_;
  // Per vertex: whether the vertex can no longer collapse in this level.
  std::vector<std::uint8_t> is_taken_;
  // Per vertex: sum of the positions of its non-virtual neighbours.
  std::vector<Vec3> ring_sum_;
  std::vector<std::uint32_t> ring_size_;
  double mean_edge_ = 0, reach_ = 0;  // reach_: distance limit for keeps_near()
  std::vector<Pick> picks_;
  std::vector<std::optional<Vec3i>> targets_;  // results of check() for the next edges
};

}  // namespace vitrine::inline codec
