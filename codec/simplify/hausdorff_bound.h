// SPDX-License-Identifier: Apache-2.0
// A true upper bound on how far one surface is from another, by branch and bound.
//
// The distance to one triangle S, a "witness", is convex, so over a convex piece of the surface it
// is largest at a corner: the largest corner distance bounds the piece's distance to the whole
// target. A piece with too weak a bound is cut along an edge of S, beyond which the neighbour of S
// takes over, and halved where that does not help. Most triangles never come to that: they lie
// under a patch of the target (see patch_cover.h). Where the target's triangles are much smaller
// than what is allowed, a few true distances settle a triangle sooner than its patch would.
//
// Sheets that cross or lie on each other can ask for a piece for each square of the precision: the
// work is bounded by growing what counts as negligible.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/triangle_bvh.h"
#include "codec/simplify/convex_piece.h"
#include "codec/simplify/patch_cover.h"
#include "codec/simplify/witness_surface.h"

namespace vitrine {

// A surface in regions. A triangle counts for the regions of its corners.
struct RegionedSurface {
  const TriangleBvh& bvh;
  std::vector<std::uint16_t> region;  // per vertex of `bvh`, from 0 on; empty: all are in region 0

  // Of a triangle's corners: first those that differ, then repetitions of the last.
  std::array<std::uint16_t, 3> regions(std::uint32_t triangle) const {
    if (region.empty()) return {};
    const Triangle& f = bvh.faces()[triangle];
    const std::uint16_t a = region[f[0]], b = region[f[1]], c = region[f[2]];
    if (a == b) return {a, c, c};
    if (a == c) return {a, b, b};
    return {a, b, c};
  }
};

class HausdorffBound {
 public:
  // Pieces are settled once their bound is at most `tolerance` (> 1) times the largest distance
  // known to occur, or below `negligible` (> 0, model units).
  // `regions` (>= 1) have bounds of their own; those of regions with small distances are less
  // tight.
  HausdorffBound(double tolerance, double negligible, std::size_t regions = 1)
      : tolerance_(tolerance), negligible_(negligible), regions_(regions) {}

  // A distance that occurs between the two surfaces in the region chosen. Many and large ones save
  // time.
  void know(double distance);

  // The region that know() and add() of a triangle count for.
  void choose(std::uint16_t region) { region_ = region; }

  // Adds the distances from every point of a triangle to `target`.
  // `near`: a triangle of it near by.
  void add(const Corners& triangle, const WitnessSurface& target, std::uint32_t near);

  // Adds the distances between two surfaces of the same faces in the same order, both ways.
  // `surface` tells the regions of both.
  void add_twins(const WitnessSurface& one, const WitnessSurface& other,
                 const RegionedSurface& surface);

  // Adds the distances from every point of `source` to `target`. Returns what is learned of the
  // triangles of `target` on the way, for the call in the other direction, where it is `known`: a
  // mark is 1 + the region within whose bound the triangle is.
  Overlaps add(const RegionedSurface& source, const WitnessSurface& target,
               const Overlaps& known = {});

  // No distance added so far is larger. At most tolerance * the largest one, or `negligible`, or,
  // where the surfaces are tangled, as near to these as a bounded number of pieces allows.
  double bound() const;
  double bound(std::size_t region) const {
    return std::max(regions_[region].known, regions_[region].bound);
  }

 private:
  static constexpr int kCuts = 16;  // in a row; rounding must not let them go on for ever
  static constexpr std::size_t kWork = 65'536;  // and 4 a face, before the precision halves
  static constexpr unsigned kMostLosses = 4;    // that quarter the work up to the next

  // Of the largest distance known anywhere: how small a region's bound is worth work.
  static constexpr double kSmallShare = 0.2;

  double limit() const {
    return std::max({tolerance_ * regions_[region_].known, kSmallShare * known_, negligible_});
  }
  void raise(double distance) {
    regions_[region_].bound = std::max(regions_[region_].bound, distance);
  }
  struct Visit;
  void visit(Visit& visit, std::uint32_t node);
  void visit_triangle(Visit& visit, std::uint32_t triangle);
  bool lay_patch(Visit& visit, const Corners& corners, std::uint32_t triangle);
  void visit_leaf(Visit& visit, const TriangleBvh::Node& node);
  bool settle_box(const TriangleBvh::Node& node);
  void approach(const Vec3& p);
  bool settle(std::span<const Vec3> corners, std::uint32_t witness);
  void cover(const ConvexPiece& piece, std::uint32_t start);
  void cut(const ConvexPiece& piece, std::uint32_t witness, int cuts);
  void examine(const ConvexPiece& piece, std::uint32_t witness);
  void spend();
  void halve(const ConvexPiece& piece, std::uint32_t start);

  double tolerance_, negligible_;
  struct Region {
    double known = 0, bound = 0;
  };
  std::vector<Region> regions_;
  std::uint16_t region_ = 0;
  double known_ = 0;       // in any region
  std::size_t spent_ = 0;  // pieces examined or halved since the precision was last changed
  unsigned losses_ = 0;
  const WitnessSurface* target_ = nullptr;
  bool fine_ = false;  // the source has the smaller triangles: one of the target may serve several
  double wide_ = 0;    // a limit above this is wide beside the target's triangles
  std::uint32_t last_ = 0;  // the newest witness: the next one is near it
};

}  // namespace vitrine
