// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/patch_cover.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vitrine {

// The prism over a triangle: height over its plane, and the side of each of its three walls.
struct PatchCover::Prism {
  Vec3 origin, normal;
  std::array<Vec3, 3> inward;
  std::array<double, 3> offset;  // of the walls from the origin
  Place centre;

  explicit Prism(const Corners& t)
      : origin(t.a), normal(cross(t.b - t.a, t.c - t.a)), inward{}, offset{}, centre{} {
    const double size = length(normal);
    normal = size > 0 ? normal * (1 / size) : Vec3{};
    inward = {cross(normal, t.b - t.a), cross(normal, t.c - t.b), cross(normal, t.a - t.c)};
    offset = {0, dot(inward[1], t.b - t.a), 0};
    centre = place((t.a + t.b + t.c) * (1.0 / 3));
  }

  bool flat() const { return normal == Vec3{}; }

  Place place(const Vec3& p) const {
    const Vec3 r = p - origin;
    return {dot(normal, r), {dot(inward[0], r), dot(inward[1], r) - offset[1], dot(inward[2], r)}};
  }
};

bool PatchCover::outside(const Place& a, const Place& b) {  // the edge is behind no wall
  for (std::size_t k = 0; k < 3; ++k) {
    if (a.depth[k] <= 0 && b.depth[k] <= 0) return true;
  }
  return false;
}

bool PatchCover::outside(const Place& a, const Place& b, const Place& c) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (a.depth[k] <= 0 && b.depth[k] <= 0 && c.depth[k] <= 0) return true;
  }
  return false;
}

PatchCover::Place PatchCover::between(const Place& a, const Place& b, double part) {
  Place p{a.height + (b.height - a.height) * part, {}};
  for (std::size_t k = 0; k < 3; ++k)
    p.depth[k] = a.depth[k] + (b.depth[k] - a.depth[k]) * part;
  return p;
}

// Twice the area of a triangle seen from above, but for a factor > 0; negative where it faces down.
double PatchCover::area(const Place& a, const Place& b, const Place& c) {
  const auto side = [&](const Place& p, std::size_t k) { return p.depth[k] - a.depth[k]; };
  return side(b, 0) * side(c, 1) - side(b, 1) * side(c, 0);
}

bool PatchCover::inside(const Place& p) {
  return p.depth[0] >= 0 && p.depth[1] >= 0 && p.depth[2] >= 0;
}

PatchCover::PatchCover(const WitnessSurface& surface)
    : surface_(surface), marks_(surface.size(), 0), seen_(surface.size(), 0) {}

PatchCover::Result PatchCover::cover(const Corners& triangle, std::uint32_t start, double limit,
                                     std::uint16_t mark) {
  mark_ = mark;
  Result result;
  const Prism prism(triangle);
  if (prism.flat()) return result;
  bool over_centre = false;
  ++call_;
  seen_[start] = call_;
  open_.assign(
      1, {start, 0, prism.place(surface_.point(start, 0)), prism.place(surface_.point(start, 1))});
  while (!open_.empty()) {
    const Open open = open_.back();
    open_.pop_back();
    if (!step(prism, open, limit, result, over_centre)) return result;
  }
  result.covered = over_centre;
  return result;
}

// The largest height that a triangle has over the prism: it is cut at one wall after the other.
double PatchCover::height_inside(const std::array<Place, 3>& places) {
  std::array<Place, 9> polygon, cut;  // six corners, but for what rounding may add
  std::ranges::copy(places, polygon.begin());
  std::size_t size = places.size();
  for (std::size_t wall = 0; wall < 3; ++wall) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const Place &p = polygon[i], &q = polygon[i + 1 < size ? i + 1 : 0];
      const double here = p.depth[wall], there = q.depth[wall];
      if (here >= 0) cut[kept++] = p;
      if ((here < 0 && there > 0) || (here > 0 && there < 0))
        cut[kept++] = between(p, q, here / (here - there));
    }
    polygon = cut, size = kept;
  }
  double height = 0;
  for (std::size_t i = 0; i < size; ++i)
    height = std::max(height, std::abs(polygon[i].height));
  return height;
}

// Takes triangle t into the patch if it reaches into the prism. False if the patch is no cover.
bool PatchCover::step(const Prism& prism, const Open& open, double limit, Result& result,
                      bool& over_centre) {
  const std::uint32_t t = open.triangle;
  std::array<Place, 3> places;
  places[open.edge] = open.from, places[(open.edge + 1) % 3] = open.to;
  const std::uint32_t apex = (open.edge + 2) % 3;
  places[apex] = prism.place(surface_.point(t, apex));
  if (outside(places[0], places[1], places[2])) return true;
  double height = std::max(
      {std::abs(places[0].height), std::abs(places[1].height), std::abs(places[2].height)});
  if (height > limit) height = height_inside(places);
  if (height > limit || !(area(places[0], places[1], places[2]) > 0)) return false;
  result.height = std::max(result.height, height);
  if (inside(places[0]) && inside(places[1]) && inside(places[2])) marks_[t] = mark_;
  over_centre = over_centre || (area(places[0], places[1], prism.centre) >= 0 &&
                                area(places[1], places[2], prism.centre) >= 0 &&
                                area(places[2], places[0], prism.centre) >= 0);
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t other = surface_.across(t, k);
    if (seen_[other] == call_ && other != t) continue;
    if (outside(places[k], places[(k + 1) % 3])) continue;
    if (other == t) return false;
    seen_[other] = call_;
    open_.push_back({other, surface_.edge_across(t, k), places[(k + 1) % 3], places[k]});
  }
  return true;
}

}  // namespace vitrine
