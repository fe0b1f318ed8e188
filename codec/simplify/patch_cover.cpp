// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/patch_cover.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vitrine {

// The prism over a triangle: height over its plane, and the side of each of its three walls.
struct PatchCover::Prism {
  Vec3 origin, normal, centre;
  std::array<Vec3, 3> inward;
  std::array<double, 3> offset;  // of the walls from the origin

  explicit Prism(const Corners& t)
      : origin(t.a),
        normal(cross(t.b - t.a, t.c - t.a)),
        centre((t.a + t.b + t.c) * (1.0 / 3)),
        inward{},
        offset{} {
    const double size = length(normal);
    normal = size > 0 ? normal * (1 / size) : Vec3{};
    inward = {cross(normal, t.b - t.a), cross(normal, t.c - t.b), cross(normal, t.a - t.c)};
    offset = {0, dot(inward[1], t.b - t.a), 0};
  }

  bool flat() const { return normal == Vec3{}; }

  Place place(const Vec3& p) const {
    const Vec3 r = p - origin;
    return {std::abs(dot(normal, r)),
            {dot(inward[0], r), dot(inward[1], r) - offset[1], dot(inward[2], r)}};
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

bool PatchCover::inside(const Place& p) {
  return p.depth[0] >= 0 && p.depth[1] >= 0 && p.depth[2] >= 0;
}

namespace {

// True if the line through p along `normal` meets the triangle, which faces that way.
bool over(const Corners& t, const Vec3& p, const Vec3& normal) {
  return dot(cross(t.b - t.a, p - t.a), normal) >= 0 &&
         dot(cross(t.c - t.b, p - t.b), normal) >= 0 && dot(cross(t.a - t.c, p - t.c), normal) >= 0;
}

}  // namespace

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
  const Corners first = surface_.triangle(start);
  open_.assign(1, {start, 0, prism.place(first.a), prism.place(first.b)});
  while (!open_.empty()) {
    const Open open = open_.back();
    open_.pop_back();
    if (!step(prism, open, limit, result, over_centre)) return result;
  }
  result.covered = over_centre;
  return result;
}

// Takes triangle t into the patch if it reaches into the prism. False if the patch is no cover.
bool PatchCover::step(const Prism& prism, const Open& open, double limit, Result& result,
                      bool& over_centre) {
  const std::uint32_t t = open.triangle;
  const Corners s = surface_.triangle(t);
  std::array<Place, 3> places;
  places[open.edge] = open.from, places[(open.edge + 1) % 3] = open.to;
  places[(open.edge + 2) % 3] = prism.place(corner(s, (open.edge + 2) % 3));
  if (outside(places[0], places[1], places[2])) return true;
  const double height = std::max({places[0].height, places[1].height, places[2].height});
  if (height > limit || dot(cross(s.b - s.a, s.c - s.a), prism.normal) <= 0) return false;
  result.height = std::max(result.height, height);
  if (inside(places[0]) && inside(places[1]) && inside(places[2])) marks_[t] = mark_;
  over_centre = over_centre || over(s, prism.centre, prism.normal);
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
