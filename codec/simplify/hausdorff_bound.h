// SPDX-License-Identifier: Apache-2.0
// A true upper bound on how far one surface is from another, by branch and bound.
//
// The distance to one triangle S, a "witness", is convex, so over a convex piece of the surface it
// is largest at a corner: the largest corner distance bounds the piece's distance to the whole
// target. A piece with too weak a bound is cut along an edge of S, beyond which the neighbour of S
// takes over, and halved where that does not help. Most triangles never come to that: they lie
// under a patch of the target (see patch_cover.h).
//
// Sheets that cross or lie on each other can ask for a piece for each square of the precision: the
// work is bounded by growing what counts as negligible.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/triangle_bvh.h"
#include "codec/simplify/convex_piece.h"
#include "codec/simplify/patch_cover.h"
#include "codec/simplify/witness_surface.h"

namespace vitrine {

class HausdorffBound {
 public:
  // Pieces are settled once their bound is at most `tolerance` (> 1) times the largest distance
  // known to occur, or below `negligible` (> 0, model units).
  HausdorffBound(double tolerance, double negligible)
      : tolerance_(tolerance), negligible_(negligible) {}

  // A distance that occurs between the two surfaces. Many and large ones save time.
  void know(double distance) { known_ = std::max(known_, distance); }

  // Adds the distances from every point of a triangle to `target`.
  // `near`: a triangle of it near by.
  void add(const Corners& triangle, const WitnessSurface& target, std::uint32_t near);

  // Adds the distances between two surfaces of the same faces in the same order, both ways.
  void add_twins(const WitnessSurface& one, const WitnessSurface& other);

  // Adds the distances from every point of `source` to `target`, save for the triangles marked in
  // `settled` (empty: none). Returns marks for the triangles of `target`: those whose distance to
  // `source` is found to be within bound() on the way, for the call in the other direction.
  std::vector<std::uint8_t> add(const TriangleBvh& source, const WitnessSurface& target,
                                std::span<const std::uint8_t> settled = {});

  // No distance added so far is larger. At most tolerance * the largest one, or `negligible`, or,
  // where the surfaces are tangled, as near to these as a bounded number of pieces allows.
  double bound() const { return std::max(known_, bound_); }

 private:
  static constexpr int kCuts = 16;  // in a row; rounding must not let them go on for ever
  static constexpr std::size_t kWork = 65'536;  // and 4 a face, before the precision halves
  static constexpr unsigned kMostLosses = 4;    // that quarter the work up to the next

  double limit() const { return std::max(tolerance_ * known_, negligible_); }
  struct Visit;
  void visit(Visit& visit, std::uint32_t node);
  void visit_triangle(const Corners& triangle, PatchCover& patches);
  bool settle_box(const TriangleBvh::Node& node);
  void approach(const Vec3& p);
  bool settle(std::span<const Vec3> corners, std::uint32_t witness);
  void cover(const ConvexPiece& piece, std::uint32_t start);
  void cut(const ConvexPiece& piece, std::uint32_t witness, int cuts);
  void examine(const ConvexPiece& piece, std::uint32_t witness);
  void spend();
  void halve(const ConvexPiece& piece, std::uint32_t start);

  double tolerance_, negligible_;
  double known_ = 0, bound_ = 0;
  std::size_t spent_ = 0;  // pieces examined or halved since the precision was last changed
  unsigned losses_ = 0;
  const WitnessSurface* target_ = nullptr;
  std::uint32_t last_ = 0;  // the newest witness: the next one is near it
};

}  // namespace vitrine
