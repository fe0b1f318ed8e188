// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/hausdorff_bound.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vitrine {
namespace {

// A piece is halved at once where radius^4 exceeds this many times (twice the witness' area)^2.
constexpr double kManyWitnesses = 16;
// Where the source has so many times the triangles of the target, one witness may serve a whole
// one.
constexpr std::size_t kFine = 2;
// Of the limit: the radius of a piece that one true distance may settle.
constexpr double kOneDistance = 0.9;
constexpr double kSlack = 1e-6;  // of the limit: what a cut may leave standing
// Where the limit is so many times as wide as the target's triangles, a triangle of the source
// needs far fewer pieces that one true distance settles than a patch over it has triangles.
constexpr double kWide = 4;

Vec3 centre_of(const Corners& t) {
  return (t.a + t.b + t.c) * (1.0 / 3);
}

double squared_area(const Corners& t) {  // of the parallelogram
  const Vec3 normal = normal_of(t);
  return dot(normal, normal);
}

// The root of the mean of twice the area, of a sample of the triangles.
double typical_width(const WitnessSurface& surface) {
  constexpr std::uint32_t kStride = 64;
  double area = 0, count = 0;
  for (std::uint32_t t = 0; t < surface.size(); t += kStride)
    area += std::sqrt(squared_area(surface.triangle(t))), ++count;
  return std::sqrt(area / std::max(count, 1.0));
}

constexpr std::uint16_t kSeveral = 0xFFFF;

// How many of them are different; these come first.
std::size_t kinds(const std::array<std::uint16_t, 3>& r) {
  return r[0] == r[1] ? 1 : r[1] == r[2] ? 2 : 3;
}

// The region of all triangles of a leaf, or kSeveral.
std::uint16_t leaf_region(const RegionedSurface& surface, const TriangleBvh::Node& leaf) {
  const std::uint16_t first = surface.regions(leaf.first)[0];
  for (std::uint32_t t = leaf.first; t < leaf.first + leaf.count; ++t) {
    const auto regions = surface.regions(t);
    if (kinds(regions) > 1 || regions[0] != first) return kSeveral;
  }
  return first;
}

// Children come behind their parents.
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

struct Edge {
  std::uint32_t index = 0;
  double overhang = 0;
};

// The edge of the witness beyond which the piece reaches farthest.
Edge most_overhung(const ConvexPiece& piece, const WitnessSurface& target, std::uint32_t witness) {
  Edge most;
  for (const Vec3& p : piece.corners()) {
    const std::array<double, 3> overhang = target.overhang(p, witness);
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (overhang[k] > most.overhang) most = {k, overhang[k]};
    }
  }
  return most;
}

}  // namespace

void HausdorffBound::add(const Corners& triangle, const WitnessSurface& target,
                         std::uint32_t near) {
  target_ = &target;
  last_ = target.closest(centre_of(triangle), near).triangle;
  cover(ConvexPiece(triangle), last_);
}

void HausdorffBound::know(double distance) {
  regions_[region_].known = std::max(regions_[region_].known, distance);
  known_ = std::max(known_, distance);
}

double HausdorffBound::bound() const {
  double most = 0;
  for (std::size_t k = 0; k < regions_.size(); ++k)
    most = std::max(most, bound(k));
  return most;
}

// Points at the same place of twin triangles are no farther apart than the farthest corners are.
void HausdorffBound::add_twins(const WitnessSurface& one, const WitnessSurface& other,
                               const RegionedSurface& surface) {
  for (std::uint32_t t = 0; t < one.size(); ++t) {
    const Corners a = one.triangle(t), b = other.triangle(t);
    const double apart = std::max({length(a.a - b.a), length(a.b - b.b), length(a.c - b.c)});
    const auto regions = surface.regions(t);
    for (std::size_t k = 0; k < kinds(regions); ++k) {
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
  std::vector<std::uint16_t> node_regions;  // per node: the region of all below it, or kSeveral
  PatchCover patches;
};

Overlaps HausdorffBound::add(const RegionedSurface& source, const WitnessSurface& target,
                             const Overlaps& known) {
  target_ = &target;
  fine_ = source.bvh.size() >= kFine * target.size();
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
    for (std::size_t k = 0; k < kinds(regions); ++k) {
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
  const Corners triangle = all.source.bvh.triangle(t);
  const Vec3 centre = centre_of(triangle);
  last_ = target_->stroll(centre, last_);
  if (fine_ && settle(std::array{triangle.a, triangle.b, triangle.c}, last_)) return;
  if (limit() > wide_) return cover(ConvexPiece(triangle), last_);
  if (lay_patch(all, triangle, t)) return;
  // The way there may have led to another sheet of the surface.
  const SurfacePoint nearest = target_->closest(centre, last_);
  know(std::sqrt(nearest.squared));
  if (nearest.triangle != last_) {
    last_ = nearest.triangle;
    if (lay_patch(all, triangle, t)) return;
  }
  cover(ConvexPiece(triangle), last_);
}

// True if a patch around the newest witness covers triangle t of the source.
bool HausdorffBound::lay_patch(Visit& all, const Corners& triangle, std::uint32_t t) {
  const PatchCover::Result patch =
      all.patches.cover(triangle, t, last_, limit(), static_cast<std::uint16_t>(region_ + 1));
  raise(patch.height);
  return patch.covered;
}

// True if one witness serves the whole box.
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

// Moves the newest witness near p: by a walk, unless that ends too far away.
void HausdorffBound::approach(const Vec3& p) {
  last_ = target_->stroll(p, last_);
  if (target_->farthest_within({&p, 1}, last_, limit()) > limit())
    last_ = target_->closest(p, last_).triangle;
}

bool HausdorffBound::settle(std::span<const Vec3> corners, std::uint32_t witness) {
  const double most = limit(), farthest = target_->farthest_within(corners, witness, most);
  if (farthest > most) return false;
  raise(farthest);
  return true;
}

void HausdorffBound::cover(const ConvexPiece& piece, std::uint32_t start) {
  const Vec3 centre = piece.centre();
  const std::uint32_t witness = last_ = target_->walk(centre, start);
  if (settle(piece.corners(), witness)) return;
  const double radius = piece.radius(centre);
  const double area = squared_area(target_->triangle(witness));
  const bool much_larger = radius * radius * radius * radius > kManyWitnesses * area;
  if (!much_larger) return cut(piece, witness, kCuts);
  // A walk may end among faces without area, which say nothing of the surface's size near by.
  if (radius > limit() * kOneDistance && area > 0) return halve(piece, witness);
  examine(piece, witness);
}

void HausdorffBound::cut(const ConvexPiece& piece, std::uint32_t witness, int cuts) {
  if (settle(piece.corners(), witness)) return;
  const Edge edge = most_overhung(piece, *target_, witness);
  const double slack = kSlack * limit();
  if (cuts == 0 || piece.full() || edge.overhang <= slack) return examine(piece, witness);
  const auto [point, normal] = target_->bisector(witness, edge.index);
  const ConvexPiece::Cut parts = piece.cut(point, normal, slack);
  if (parts.back.empty()) return examine(piece, witness);
  if (!parts.front.empty()) cut(parts.front, witness, cuts - 1);
  cut(parts.back, target_->across(witness, edge.index), cuts - 1);
}

// Where no witness near by is good enough, true distances decide.
void HausdorffBound::examine(const ConvexPiece& piece, std::uint32_t witness) {
  spend();
  const Vec3 centre = piece.centre();
  const SurfacePoint middle = target_->closest(centre, witness);
  know(std::sqrt(middle.squared));
  if (settle(piece.corners(), middle.triangle)) return;
  // The distance grows no faster than one moves.
  const double reach = std::sqrt(middle.squared) + piece.radius(centre);
  if (reach <= limit()) {
    raise(reach);
    return;
  }
  for (const Vec3& p : piece.corners()) {
    const double known = regions_[region_].known;
    if (target_->farthest_within({&p, 1}, witness, known) <= known) continue;
    know(std::sqrt(target_->closest(p, middle.triangle).squared));
  }
  halve(piece, middle.triangle);
}

// Each loss of precision comes sooner than the last: a tangle is given up in time.
void HausdorffBound::spend() {
  if (++spent_ <= (kWork + 4 * target_->size()) >> (2 * losses_)) return;
  negligible_ *= 2, spent_ = 0;
  losses_ = std::min(losses_ + 1, kMostLosses);
}

void HausdorffBound::halve(const ConvexPiece& piece, std::uint32_t start) {
  spend();
  const ConvexPiece::Cut parts = piece.halves();
  if (parts.front.empty() || parts.back.empty()) {  // smaller than coordinates can tell
    const Vec3 centre = piece.centre();
    raise(std::sqrt(target_->closest(centre, start).squared) + piece.radius(centre));
    return;
  }
  cover(parts.front, start);
  cover(parts.back, start);
}

}  // namespace vitrine
