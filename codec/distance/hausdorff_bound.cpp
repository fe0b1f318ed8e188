// SPDX-License-Identifier: Apache-2.0
#include "codec/distance/hausdorff_bound.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vitrine::inline codec {
namespace {

// A piece counts as much larger than its witness if radius^4 > kManyWitnesses * (2 * area of the
// witness)^2. Such a piece is not cut along the witness's edges. If the target is slender
// (triangle_bvh.h), the square of the witness's longest edge replaces 2 * area.
constexpr double kManyWitnesses = 16;
// The source counts as finer than the target if it has at least kFine times as many triangles. If
// it is finer, the distance to one witness may bound a whole triangle of the source.
constexpr std::size_t kFine = 2;
// Largest radius, as a share of limit(), of a piece that one exact distance can settle.
constexpr double kOneDistance = 0.9;
// An edge cuts a piece only if the piece reaches beyond the edge by more than this share of
// limit().
constexpr double kSlack = 1e-6;
// If limit() exceeds kWide times the width of the target's triangles, a few exact distances settle
// a triangle of the source faster than a patch of the target does.
constexpr double kWide = 4;

Vec3 centre_of(const TrianglePoints& t) {
  return (t.a + t.b + t.c) * (1.0 / 3);
}

// Returns the square of twice the triangle's area.
double squared_area(const TrianglePoints& t) {
  const Vec3 normal = normal_of(t);
  return dot(normal, normal);
}

// Returns the fourth power of the length of the triangle's longest edge.
double fourth_power_of_longest_edge(const TrianglePoints& t) {
  const Vec3 ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c;
  const double squared = std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)});
  return squared * squared;
}

// Returns the square root of twice the mean triangle area. Uses every 64th triangle.
double typical_width(const WitnessSurface& surface) {
  constexpr std::uint32_t kStride = 64;
  double area = 0, count = 0;
  for (std::uint32_t t = 0; t < surface.size(); t += kStride)
    area += std::sqrt(squared_area(surface.triangle(t))), ++count;
  return std::sqrt(area / std::max(count, 1.0));
}

constexpr std::uint16_t kSeveral = 0xFFFF;

// Returns the number of distinct regions in `r`, a result of RegionedSurface::regions().
std::size_t count_distinct(const std::array<std::uint16_t, 3>& r) {
  return r[0] == r[1] ? 1 : r[1] == r[2] ? 2 : 3;
}

// Returns the region of a leaf's triangles, or kSeveral if the triangles are in different regions.
std::uint16_t leaf_region(const RegionedSurface& surface, const TriangleBvh::Node& leaf) {
  const std::uint16_t first = surface.regions(leaf.first)[0];
  for (std::uint32_t t = leaf.first; t < leaf.first + leaf.count; ++t) {
    const auto regions = surface.regions(t);
    if (count_distinct(regions) > 1 || regions[0] != first) return kSeveral;
  }
  return first;
}

// Computes the region of each node from the regions of its children. Runs backwards, because
// children have higher indices than their parents.
std::vector<std::uint16_t> node_regions(const RegionedSurface& surface) {
  const std::span<const TriangleBvh::Node> nodes = surface.bvh.nodes();
  std::vector<std::uint16_t> out(nodes.size(), 0);
  if (surface.region.empty()) return out;
  for (std::size_t i = out.size(); i-- > 0;) {
    const TriangleBvh::Node& node = nodes[i];
    if (node.count > 0) {
      out[i] = leaf_region(surface, node);
    } else {
      out[i] = out[node.first] == out[node.first + 1] ? out[node.first] : kSeveral;
    }
  }
  return out;
}

struct OverhungEdge {
  std::uint32_t index = 0;
  double overhang = 0;
};

// Returns the edge of the witness beyond which the piece extends farthest.
OverhungEdge most_overhung(const ConvexPiece& piece, const WitnessSurface& target,
                           std::uint32_t witness) {
  OverhungEdge most;
  for (const Vec3& p : piece.corners()) {
    const std::array<double, 3> overhang = target.overhang(p, witness);
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (overhang[k] > most.overhang) most = {k, overhang[k]};
    }
  }
  return most;
}

}  // namespace

void HausdorffBound::add(const TrianglePoints& triangle, const WitnessSurface& target,
                         std::uint32_t near) {
  target_ = &target;
  last_ = search(centre_of(triangle), near).triangle;
  cover(ConvexPiece(triangle), last_);
}

void HausdorffBound::know_distance(double distance) {
  regions_[region_].known = std::max(regions_[region_].known, distance);
  known_ = std::max(known_, distance);
}

double HausdorffBound::bound() const {
  double most = 0;
  for (std::size_t k = 0; k < regions_.size(); ++k)
    most = std::max(most, bound(k));
  return most;
}

// Compares only the corners. The distance between corresponding points of two triangles is a convex
// function, so it is largest at a corner.
void HausdorffBound::add_twins(const WitnessSurface& one, const WitnessSurface& other,
                               const RegionedSurface& surface) {
  for (std::uint32_t t = 0; t < one.size(); ++t) {
    const TrianglePoints a = one.triangle(t), b = other.triangle(t);
    const double apart = std::max({length(a.a - b.a), length(a.b - b.b), length(a.c - b.c)});
    const auto regions = surface.regions(t);
    for (std::size_t k = 0; k < count_distinct(regions); ++k) {
      region_ = regions[k];
      if (apart <= limit()) {
        raise(apart);
      } else {
        add(a, other, t);
        add(b, one, t);
      }
    }
  }
}

struct HausdorffBound::Visit {
  const RegionedSurface& source;
  const Overlaps& known;
  // Per node: the region of all triangles below the node, or kSeveral.
  std::vector<std::uint16_t> node_regions;
  PatchCover patches;
};

Overlaps HausdorffBound::add(const RegionedSurface& source, const WitnessSurface& target,
                             const Overlaps& known) {
  target_ = &target;
  is_source_finer_ = source.bvh.size() >= kFine * target.size();
  wide_ = kWide * typical_width(target);
  last_ = 0;
  Visit all{source, known, node_regions(source), PatchCover(target)};
  visit(all, 0);
  return std::move(all.patches).overlaps();
}

void HausdorffBound::visit(Visit& all, std::uint32_t index) {
  const TriangleBvh::Node& node = all.source.bvh.nodes()[index];
  if (all.node_regions[index] != kSeveral) {
    region_ = all.node_regions[index];
    if (settle_box(node)) return;
  }
  if (node.count != 0) return visit_leaf(all, node);
  visit(all, node.first);
  visit(all, node.first + 1);
}

void HausdorffBound::visit_leaf(Visit& all, const TriangleBvh::Node& node) {
  bool near = false;
  for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
    const auto regions = all.source.regions(t);
    for (std::size_t k = 0; k < count_distinct(regions); ++k) {
      region_ = regions[k];
      if (!all.known.mark.empty() && all.known.mark[t] == region_ + 1) continue;
      if (const auto start = all.known.near(t)) {
        last_ = *start;
      } else if (!near) {
        approach(centre_of(all.source.bvh.triangle(t)));
      }
      near = true;
      visit_triangle(all, t);
    }
  }
}

void HausdorffBound::visit_triangle(Visit& all, std::uint32_t t) {
  const TrianglePoints triangle = all.source.bvh.triangle(t);
  const Vec3 centre = centre_of(triangle);
  last_ = target_->stroll(centre, last_);
  // A coarse precision often needs neither a patch nor a search.
  const bool is_easy = is_source_finer_ || is_coarse_;
  if (is_easy && settle(std::array{triangle.a, triangle.b, triangle.c}, last_)) return;
  if (limit() > wide_) return cover(ConvexPiece(triangle), last_);
  if (lay_patch(all, triangle, t)) return;
  // The walk from triangle to triangle may have ended on another sheet of the surface. Therefore
  // searches the whole target for the closest triangle.
  const ClosestTriangle nearest = search(centre, last_);
  know_distance(std::sqrt(nearest.at_least));
  if (nearest.triangle != last_) {
    last_ = nearest.triangle;
    if (lay_patch(all, triangle, t)) return;
  }
  cover(ConvexPiece(triangle), last_);
}

// Tries to cover triangle t of the source by a patch that starts at the last witness. Returns true
// on success.
bool HausdorffBound::lay_patch(Visit& all, const TrianglePoints& triangle, std::uint32_t t) {
  const PatchCover::CoverResult patch =
      all.patches.cover(triangle, t, last_, limit(), static_cast<std::uint16_t>(region_ + 1));
  raise(patch.height);
  return patch.is_covered;
}

// Tries to bound all triangles in a box by one witness. Returns true on success.
bool HausdorffBound::settle_box(const TriangleBvh::Node& n) {
  const Vec3 low{n.low[0], n.low[1], n.low[2]}, high{n.high[0], n.high[1], n.high[2]};
  if (length(high - low) > limit()) return false;
  approach((low + high) * 0.5);
  std::array<Vec3, 8> corners;
  for (unsigned k = 0; k < 8; ++k) {
    corners[k] = {k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z};
  }
  return settle(corners, last_);
}

// Moves the last witness close to p: first by a walk over neighbouring triangles, then by a search
// if the walk ends too far from p.
void HausdorffBound::approach(const Vec3& p) {
  last_ = target_->stroll(p, last_);
  if (target_->farthest_within({&p, 1}, last_, limit()) > limit())
    last_ = search(p, last_).triangle;
}

bool HausdorffBound::settle(std::span<const Vec3> corners, std::uint32_t witness) {
  const double most = limit(), farthest = target_->farthest_within(corners, witness, most);
  if (farthest > most) return false;
  raise(farthest);
  return true;
}

// Bounds the piece, and then its parts one after the other. Uses an explicit stack, because the
// depth of a recursion would depend on the surface.
void HausdorffBound::cover(const ConvexPiece& piece, std::uint32_t start) {
  open_.push_back({piece, start, kUncut});
  while (!open_.empty()) {
    const OpenPiece next = open_.back();
    open_.pop_back();
    if (next.cuts == kUncut) {
      choose_witness(next.piece, next.witness);
    } else {
      cut(next);
    }
  }
}

// Finds a witness near the piece. If it does not settle the piece, chooses how to divide the piece.
void HausdorffBound::choose_witness(const ConvexPiece& piece, std::uint32_t start) {
  const Vec3 centre = piece.centre();
  const std::uint32_t witness = last_ = target_->walk(centre, start);
  if (settle(piece.corners(), witness)) return;
  const double radius = piece.radius(centre);
  const TrianglePoints triangle = target_->triangle(witness);
  const bool slender = target_->is_slender();
  const double size = slender ? fourth_power_of_longest_edge(triangle) : squared_area(triangle);
  const bool much_larger = radius * radius * radius * radius > kManyWitnesses * size;
  if (!much_larger) return cut({piece, witness, slender ? kSlenderCuts : kCuts});
  // A walk may end at a triangle without area, whose size says nothing about the sizes of its
  // neighbours.
  if (radius > limit() * kOneDistance && size > 0) return halve(piece, witness);
  examine(piece, witness);
}

// Cuts a part off the piece, unless the witness settles the piece. The part that keeps the witness
// may have to be cut as well, but only along the witness's other edges.
void HausdorffBound::cut(const OpenPiece& open) {
  const auto& [piece, witness, cuts] = open;
  if (settle(piece.corners(), witness)) return;
  const OverhungEdge edge = most_overhung(piece, *target_, witness);
  const double slack = kSlack * limit();
  if (cuts == 0 || piece.is_full() || edge.overhang <= slack) return examine(piece, witness);
  const auto [point, normal] = target_->bisector(witness, edge.index);
  const ConvexPiece::Parts parts = piece.cut(point, normal, slack);
  if (parts.back.empty()) return examine(piece, witness);
  ++cuts_;
  const int left = cuts - 1;
  if (left >= kCuts && left % kCuts == 0) spend();
  open_.push_back({parts.back, target_->across(witness, edge.index), left});
  if (!parts.front.empty()) open_.push_back({parts.front, witness, left});
}

// Bounds a piece by exact distances, because no nearby witness gives a good enough bound.
void HausdorffBound::examine(const ConvexPiece& piece, std::uint32_t witness) {
  spend();
  const Vec3 centre = piece.centre();
  const ClosestTriangle middle = search(centre, witness);
  know_distance(std::sqrt(middle.at_least));
  if (settle(piece.corners(), middle.triangle)) return;
  // A point's distance to the target changes by at most the length of the point's move, because the
  // distance is 1-Lipschitz.
  const double reach = std::sqrt(middle.squared) + piece.radius(centre);
  if (reach <= limit()) {
    raise(reach);
    return;
  }
  for (const Vec3& p : piece.corners()) {
    const double known = regions_[region_].known;
    if (target_->farthest_within({&p, 1}, witness, known) <= known) continue;
    know_distance(std::sqrt(search(p, middle.triangle).at_least));
  }
  halve(piece, middle.triangle);
}

// Finds the closest triangle of the target. Counts the visited nodes as work.
ClosestTriangle HausdorffBound::search(const Vec3& p, std::uint32_t hint) {
  const ClosestTriangle found = target_->closest(p, hint);
  spent_ += found.visited / kNodesPerUnit;
  return found;
}

// Counts one unit of work. Lowers the precision after a certain amount of work. The total time is
// therefore bounded, even if the surfaces cross or coincide. The new precision is a multiple of
// limit(), because a precision finer than limit() would save no work.
void HausdorffBound::spend() {
  const std::size_t most = (kWork + target_->size()) / (is_coarse_ ? kLaterWork : 1);
  if (++spent_ <= most) return;
  negligible_ = kCoarser * limit(), spent_ = 0, is_coarse_ = true;
}

void HausdorffBound::halve(const ConvexPiece& piece, std::uint32_t start) {
  spend();
  ++cuts_;
  const ConvexPiece::Parts parts = piece.halves();
  // A cut yields an empty part if the piece is so small that doubles cannot resolve it.
  if (parts.front.empty() || parts.back.empty()) {
    const Vec3 centre = piece.centre();
    raise(std::sqrt(search(centre, start).squared) + piece.radius(centre));
    return;
  }
  open_.push_back({parts.back, start, kUncut});
  open_.push_back({parts.front, start, kUncut});
}

}  // namespace vitrine::inline codec
