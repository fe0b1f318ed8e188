// SPDX-License-Identifier: Apache-2.0
// Proves an upper bound on the distance from one surface, the source, to another, the target, by
// branch and bound.
//
// The distance to one triangle S of the target, called the witness, is a convex function. On a
// convex piece of the source it is therefore largest at a corner. The largest corner distance
// bounds the distance from the whole piece to the target. If that bound is too weak, the piece is
// cut along an edge of S, and the neighbour of S becomes the witness beyond that edge. If a cut
// does not help, the piece is halved.
//
// Most triangles of the source are not cut, because a patch of the target covers them
// (patch_cover.h). If the triangles of the target are much smaller than the limit, a few exact
// distances settle a triangle of the source faster than a patch.
//
// Surfaces with sheets that cross or coincide can need very many pieces: one for each square whose
// side equals the precision. The precision is therefore lowered as the work grows, which bounds the
// work.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/distance/convex_piece.h"
#include "codec/distance/patch_cover.h"
#include "codec/distance/witness_surface.h"
#include "codec/mesh/triangle_bvh.h"

namespace vitrine::inline codec {

// A surface whose vertices are divided into regions. A triangle belongs to the region of each of
// its corners.
struct RegionedSurface {
  const TriangleBvh& bvh;
  // Per vertex of `bvh`: its region, numbered from 0. Empty if all vertices are in region 0.
  std::vector<std::uint16_t> region;

  // Returns the regions of a triangle's corners. The distinct regions come first; the last of them
  // is repeated to fill the array.
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
  // A piece is settled if its bound is at most `tolerance` (> 1) times the largest known distance,
  // or at most `negligible` (> 0, model units). Each of `regions` (>= 1) regions has its own bound.
  // Regions with small distances get bounds that are less tight.
  HausdorffBound(double tolerance, double negligible, std::size_t regions = 1)
      : tolerance_(tolerance), negligible_(negligible), regions_(regions) {}

  // Records a distance that occurs between the two surfaces in the chosen region. Knowing a large
  // distance early saves time later.
  void know(double distance);

  // Chooses the region to which know(), and add() of a single triangle, apply.
  void choose(std::uint16_t region) { region_ = region; }

  // Adds the distances from every point of a triangle to `target`. `near` is a hint for the search:
  // a triangle of `target` close to `triangle`.
  void add(const TrianglePoints& triangle, const WitnessSurface& target, std::uint32_t near);

  // Adds the distances between two surfaces with the same faces in the same order, in both
  // directions. `surface` holds the regions of both.
  void add_twins(const WitnessSurface& one, const WitnessSurface& other,
                 const RegionedSurface& surface);

  // Adds the distances from every point of `source` to `target`. Returns the triangles of `target`
  // found close to `source`. The call in the other direction takes this result as `known`. A mark
  // in the result is 1 + the region whose bound holds for the whole triangle.
  Overlaps add(const RegionedSurface& source, const WitnessSurface& target,
               const Overlaps& known = {});

  // Returns an upper bound of all distances added so far. It is at most `tolerance` times the
  // largest distance, or at most `negligible`. For tangled surfaces, it may be larger, because the
  // number of pieces is limited.
  double bound() const;
  double bound(std::size_t region) const {
    return std::max(regions_[region].known, regions_[region].bound);
  }

 private:
  // Maximum number of cuts in a row; without it, rounding could cause endless cuts.
  static constexpr int kCuts = 16;
  // The precision is first halved after kWork pieces, plus 4 for each face of the target.
  static constexpr std::size_t kWork = 65'536;
  // Each time the precision is halved, the number of pieces allowed before the next time is divided
  // by 4. After kMostLosses times, it is no longer divided.
  static constexpr unsigned kMostLosses = 4;

  // A region's bound is not refined below this share of the largest distance known in any region.
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
  bool lay_patch(Visit& visit, const TrianglePoints& corners, std::uint32_t triangle);
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
  double known_ = 0;       // largest distance known in any region
  std::size_t spent_ = 0;  // pieces examined or halved since the precision was last changed
  unsigned losses_ = 0;
  const WitnessSurface* target_ = nullptr;
  // Whether the source has so many more triangles than the target that one witness may bound
  // several.
  bool is_source_finer_ = false;
  // kWide times the width of the target's triangles; a larger limit() counts as wide.
  double wide_ = 0;
  std::uint32_t last_ = 0;  // the newest witness, from which the next search starts
};

}  // namespace vitrine::inline codec
