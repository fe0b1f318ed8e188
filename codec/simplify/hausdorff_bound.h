// SPDX-License-Identifier: Apache-2.0
// A true upper bound on how far one surface is from another, by branch and bound.
//
// The distance to one triangle S, a "witness", is convex, so over a convex piece of the surface it
// is largest at a corner: the largest corner distance bounds the piece's distance to the whole
// target. A piece with too weak a bound is cut along the edges of S, where another witness takes
// over, and halved where that does not help.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/face_neighbours.h"
#include "codec/mesh/triangle_bvh.h"
#include "codec/simplify/convex_piece.h"

namespace vitrine {

// A surface to which distances are bounded. The hierarchy outlives it.
class WitnessSurface {
 public:
  WitnessSurface(const TriangleBvh& bvh, const TriangleMesh& mesh);

  const TriangleBvh& bvh() const { return *bvh_; }
  const Corners& triangle(std::uint32_t t) const { return bvh_->triangles()[t]; }
  std::uint32_t across(std::uint32_t t, std::uint32_t edge) const { return across_[t][edge]; }

  // A triangle near p that no neighbour beats, found by walking from `start`.
  std::uint32_t walk(const Vec3& p, std::uint32_t start) const;
  // The closest triangle of all; `hint` speeds the search up.
  SurfacePoint closest(const Vec3& p, std::uint32_t hint) const;

 private:
  const TriangleBvh* bvh_;
  std::vector<std::array<std::uint32_t, 3>> across_;
};

class HausdorffBound {
 public:
  // Pieces are settled once their bound is at most `tolerance` (> 1) times the largest distance
  // known to occur, or below `negligible` (> 0, model units).
  HausdorffBound(double tolerance, double negligible)
      : tolerance_(tolerance), negligible_(negligible) {}

  // A distance that occurs between the two surfaces. Many and large ones save time.
  void know(double distance) { known_ = std::max(known_, distance); }

  // Adds the distances from every point of `source` to `target`, neither of them empty.
  void add(const TriangleBvh& source, const WitnessSurface& target);

  // No distance added so far is larger. At most tolerance * the largest one, or `negligible`.
  double bound() const { return std::max(known_, bound_); }

 private:
  double limit() const { return std::max(tolerance_ * known_, negligible_); }
  void visit(const TriangleBvh& source, std::uint32_t node);
  void visit_triangle(const Corners& triangle);
  bool settle_box(const TriangleBvh::Node& node);
  bool settle(std::span<const Vec3> corners, std::uint32_t witness);
  void refine(const ConvexPiece& piece, std::uint32_t start, int cuts = kCuts);
  bool cut_along(const ConvexPiece& piece, std::uint32_t witness, int cuts);
  void examine(const ConvexPiece& piece, std::uint32_t witness);
  void halve(const ConvexPiece& piece, std::uint32_t start);

  static constexpr int kCuts = 16;  // in a row

  double tolerance_, negligible_;
  double known_ = 0, bound_ = 0;
  const WitnessSurface* target_ = nullptr;
  std::uint32_t last_ = 0;  // the newest witness: the next one is near it
};

}  // namespace vitrine
