// SPDX-License-Identifier: Apache-2.0
// Proves an upper bound on the distance from one surface, the source, to another, the target, by
// branch and bound.
//
// The algorithm chooses a triangle S of the target, called the witness. The distance to S is a
// convex function. On a convex piece of the source, it is therefore largest at a corner of the
// piece. This largest corner distance bounds the distance from the whole piece to the target. If
// the bound is too weak, the piece is cut along an edge of S. Beyond that edge, the neighbour of S
// becomes the witness. If a cut does not help, the piece is halved.
//
// A piece is settled once its bound is good enough. Most triangles of the source are settled
// without cuts, because a patch of the target covers them (patch_cover.h). If the target's
// triangles are much smaller than a good enough bound, a few exact distances settle a triangle of
// the source faster than a patch.
//
// Surfaces with sheets that cross or coincide can need very many pieces, because pieces must become
// as small as the precision. The precision is therefore lowered as the work grows, which bounds the
// work. The bound remains an upper bound, but is less tight.
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

  // Returns the regions of a triangle's corners. Each different region comes once; the last one is
  // repeated to fill the array.
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
  // Bounds of regions with small distances are less tight.
  HausdorffBound(double tolerance, double negligible, std::size_t regions = 1)
      : tolerance_(tolerance), negligible_(negligible), regions_(regions) {}

  // Records a distance that occurs between the two surfaces in the chosen region. Knowing a large
  // distance early saves time later.
  void know_distance(double distance);

  // Chooses the region to which know_distance() and the single-triangle add() apply.
  void choose(std::uint16_t region) { region_ = region; }

  // Adds the distances from every point of `triangle` to `target`. `near` is a triangle of `target`
  // close to `triangle`, where the search starts.
  void add(const TrianglePoints& triangle, const WitnessSurface& target, std::uint32_t near);

  // Adds the distances, in both directions, between two surfaces with the same faces in the same
  // order. `surface` holds the regions of both.
  void add_twins(const WitnessSurface& one, const WitnessSurface& other,
                 const RegionedSurface& surface);

  // Adds the distances from every point of `source` to `target`. Returns the triangles of `target`
  // that were found close to `source`. Pass this result as `known` to the call in the other
  // direction. The mark of a triangle in the result is 1 + the number of the region whose bound
  // holds for the whole triangle.
  Overlaps add(const RegionedSurface& source, const WitnessSurface& target,
               const Overlaps& known = {});

  // Returns an upper bound of all distances added so far. The bound is at most `tolerance` times
  // the largest distance, or at most `negligible`. It may be larger if surfaces cross or coincide,
  // because the number of pieces is limited.
  double bound() const;
  double bound(std::size_t region) const {
    return std::max(regions_[region].known, regions_[region].bound);
  }

  // Returns the number of cuts of pieces so far, a measure of the work.
  std::uint64_t cuts() const { return cuts_; }

 private:
  // Maximum number of successive cuts of a piece. Without this limit, rounding could cause endless
  // cuts.
  static constexpr int kCuts = 16;
  // Maximum number of successive cuts of a piece if the target is slender: if it has long triangles
  // side by side (triangle_bvh.h). A piece over n such triangles needs n - 1 cuts. Halving would
  // need about n^2 pieces, because halves are as long as they are wide. Each kCuts cuts count as
  // one unit of work.
  static constexpr int kSlenderCuts = 1'024;
  // The precision is lowered for the first time after kWork + (faces of the target) units of work,
  // and then after each further 1 / kLaterWork of this amount. Usual surfaces need less than a
  // sixth of the amount.
  static constexpr std::size_t kWork = 16'384, kLaterWork = 4;
  // Each time the precision is lowered, `negligible_` becomes kCoarser times limit().
  static constexpr double kCoarser = 1.5;
  // A piece counts as one unit of work, and so do kNodesPerUnit nodes that searches visit. Searches
  // are long among triangles that cross. They are also long for points beyond a vertex or an edge
  // of the target, because all triangles around this vertex or edge are equally close.
  static constexpr std::uint32_t kNodesPerUnit = 64;

  // A region's bound is not refined below this share of the largest distance known in any region.
  static constexpr double kSmallShare = 0.2;

  double limit() const {
    return std::max({tolerance_ * regions_[region_].known, kSmallShare * known_, negligible_});
  }
  void raise(double distance) {
    regions_[region_].bound = std::max(regions_[region_].bound, distance);
  }
  // A piece that still has to be bounded.
  struct OpenPiece {
    ConvexPiece piece;
    std::uint32_t witness;
    int cuts;  // how often the piece may still be cut, or kUncut before its witness is chosen
  };
  static constexpr int kUncut = -1;
  struct Visit;
  void visit(Visit& visit, std::uint32_t node);
  void visit_triangle(Visit& visit, std::uint32_t triangle);
  bool lay_patch(Visit& visit, const TrianglePoints& corners, std::uint32_t triangle);
  void visit_leaf(Visit& visit, const TriangleBvh::Node& node);
  bool settle_box(const TriangleBvh::Node& node);
  void approach(const Vec3& p);
  bool settle(std::span<const Vec3> corners, std::uint32_t witness);
  void cover(const ConvexPiece& piece, std::uint32_t start);
  void choose_witness(const ConvexPiece& piece, std::uint32_t start);
  void cut(const OpenPiece& open);
  void examine(const ConvexPiece& piece, std::uint32_t witness);
  ClosestTriangle search(const Vec3& p, std::uint32_t hint);
  void spend();
  void halve(const ConvexPiece& piece, std::uint32_t start);

  double tolerance_, negligible_;
  struct Region {
    double known = 0, bound = 0;
  };
  std::vector<Region> regions_;
  std::uint16_t region_ = 0;
  double known_ = 0;        // largest distance known in any region
  std::size_t spent_ = 0;   // units of work at the current precision
  bool is_coarse_ = false;  // whether the precision has been lowered
  std::uint64_t cuts_ = 0;
  const WitnessSurface* target_ = nullptr;
  // Whether the source has at least kFine times as many triangles as the target. If so, the
  // distance to one witness may bound several triangles.
  bool is_source_finer_ = false;
  // kWide times the width of the target's triangles. If limit() exceeds this, exact distances are
  // used instead of patches.
  double wide_ = 0;
  std::vector<OpenPiece> open_;  // the piece to be bounded next is the last one
  std::uint32_t last_ = 0;       // the last witness, where the next search starts
};

}  // namespace vitrine::inline codec
