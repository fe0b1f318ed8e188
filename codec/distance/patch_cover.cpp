// SPDX-License-Identifier: Apache-2.0
#include "codec/distance/patch_cover.h"

#include <algorithm>
#include <array>
#include <bit>

namespace vitrine::inline codec {
namespace {

using Ints __attribute__((vector_size(16))) = std::int32_t;

// Error bound of a point's prism coordinates, divided by (1 + the point's distance from corner a of
// the prism's triangle). The bound covers eight roundings, and two more for safety.
constexpr float kRounding = 6e-7f;
// Largest allowed distance of a patch's points from corner a of the prism's triangle, in units of
// the prism. This keeps floats finite.
constexpr float kFarthest = 1e5f;
// A triangle is covered by patches only if twice its area exceeds this, in squared units of the
// prism.
constexpr double kLeastArea = 1e-6;
constexpr std::array<std::uint32_t, 3> kNext{1, 2, 0};
// Largest number of triangles in a patch of a slender surface (triangle_bvh.h). Without this limit,
// almost every triangle around one vertex could reach into the prism.
constexpr std::uint32_t kMostSlender = 256;

double longest_edge(const TrianglePoints& t) {
  const Vec3 ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c;
  return std::sqrt(std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)}));
}

// Returns the largest distance between the plane of `s` and a corner of `over`, measured along
// `direction`, the unit normal of `over`.
double plane_height(const TrianglePoints& s, const Vec3& direction, const TrianglePoints& over) {
  const Vec3 normal = cross(s.b - s.a, s.c - s.a);
  const double most =
      std::max({std::abs(dot(normal, s.a - over.a)), std::abs(dot(normal, s.a - over.b)),
                std::abs(dot(normal, s.a - over.c))});
  return most / std::abs(dot(normal, direction));
}

// Returns an error bound for twice the area of a triangle. `slack` is the largest error bound of
// its corners. Each side of the triangle is at most 2 slack / kRounding long.
float doubtful_area(float slack) {
  return 16 / kRounding * slack * slack;
}

float outside(float depth, float slack) {
  return std::max(slack - depth, 0.0f);
}

}  // namespace

// The prism over a triangle, stored as the triangle's plane and three walls. The unit of length is
// the triangle's longest edge. The coordinates of a point are four floats in one SIMD vector.
struct PatchCover::Prism {
  TrianglePoints base;
  Vec3 normal;
  double unit, per_unit;
  float limit;  // largest allowed height of a patch, in units of the prism
  // Twice the triangle's area in squared units of the prism, and the reciprocal of this, rounded
  // up.
  float twice_area = 0, per_area = 0;
  // Lane 0 holds the normal and the offset of the triangle's plane. Lanes 1 to 3 hold the normals
  // and offsets of the walls.
  Lanes x{}, y{}, z{}, offset{};
  Lanes centre{};

  Prism(const TrianglePoints& t, double most)
      : base(t),
        normal{},
        unit(longest_edge(t)),
        per_unit(1 / unit),
        limit(static_cast<float>(most / unit)) {
    const Vec3 ab = (t.b - t.a) * per_unit, bc = (t.c - t.b) * per_unit,
               ca = (t.a - t.c) * per_unit;
    normal = cross(ab, bc);
    const double area = length(normal);
    if (!(area > kLeastArea)) return;
    normal = normal * (1 / area);
    twice_area = static_cast<float>(area);
    per_area = (1 + kRounding) / twice_area;
    set(0, normal);
    set(1, cross(normal, ab));
    set(2, cross(normal, bc));
    set(3, cross(normal, ca));
    offset[2] = -twice_area;  // unlike walls 1 and 3, wall 2 does not contain corner a
    // The centre: a point inside the triangle. It is not the centroid, because refined meshes often
    // have vertices at centroids.
    centre = Lanes{0, 0.31f, 0.36f, 0.33f} * twice_area;
  }

  void set(std::size_t lane, const Vec3& along) {
    x[lane] = static_cast<float>(along.x);
    y[lane] = static_cast<float>(along.y);
    z[lane] = static_cast<float>(along.z);
  }

  bool is_flat() const { return per_area == 0; }

  PrismPoint place(const Vec3& p) const {
    const Vec3 r = (p - base.a) * per_unit;
    const auto rx = static_cast<float>(r.x), ry = static_cast<float>(r.y),
               rz = static_cast<float>(r.z);
    const float reach = 1 + std::abs(rx) + std::abs(ry) + std::abs(rz), slack = kRounding * reach;
    const Lanes at = x * rx + y * ry + z * rz - offset, aside = at - centre;
    const Ints bits = ((at + slack <= 0) & Ints{0, 1, 2, 4}) |
                      ((aside > 2 * slack) & Ints{0, 8, 16, 32}) |
                      ((aside < -2 * slack) & Ints{0, 64, 128, 256});
    const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(bits);
    const std::uint64_t both = halves[0] | halves[1];
    const unsigned far = reach <= kFarthest ? 0 : kFar;
    // In units of the longest edge, the sum of the absolute values of the point's negative
    // barycentric coordinates bounds its distance from the triangle.
    const float out = per_area *
                      (outside(at[1], slack) + outside(at[2], slack) + outside(at[3], slack)),
                high = std::abs(at[0]) + slack;
    return {at, slack, out * out + high * high, static_cast<unsigned>(both | both >> 32) | far};
  }
};

// Returns a multiple of the triangle's area as seen from above: positive if the triangle faces up,
// negative if it faces down.
float PatchCover::area(const Lanes& a, const Lanes& b, const Lanes& c) {
  const Lanes ab = b - a, ac = c - a;
  return ab[1] * ac[2] - ab[2] * ac[1];
}

PatchCover::PatchCover(const WitnessSurface& surface)
    : surface_(surface), marks_(surface.size(), 0), met_(surface.size(), 0) {}

PatchCover::CoverResult PatchCover::cover(const TrianglePoints& triangle, std::uint32_t number,
                                          std::uint32_t start, double limit, std::uint16_t mark) {
  const Prism prism(triangle, limit);
  if (prism.is_flat()) return {};
  calls_.push_back(number);
  call_ = static_cast<std::uint32_t>(calls_.size());
  mark_ = mark, degree_ = 0, height_ = squared_ = 0;
  const bool covered = lay(prism, start) && degree_ != 0;
  if (!covered) calls_.back() = Overlaps::kNone, height_ = 0;
  return {covered, std::max(height_, std::sqrt(squared_)) * prism.unit};
}

// Grows the patch from triangle `start` until none of its outer edges reaches into the prism.
// Returns false if the patch cannot cover the triangle.
bool PatchCover::lay(const Prism& prism, std::uint32_t start) {
  met_[start] = call_;
  open_.clear();
  const OpenTriangle first{start, 0, prism.place(surface_.point(start, 0)),
                           prism.place(surface_.point(start, 1))};
  if (!step(prism, first) || !cross_edge(prism, start, 0, first.from, first.to)) return false;
  for (std::uint32_t size = 1; !open_.empty(); ++size) {
    if (size == kMostSlender && surface_.is_slender()) return false;
    const OpenTriangle open = open_.back();
    open_.pop_back();
    if (!step(prism, open)) return false;
  }
  return true;
}

// Returns an upper bound of a triangle's height inside the prism. Tries three bounds until one is
// within the limit: the largest height of the corners, the height of the triangle's plane over the
// prism, and the height of the triangle's part inside the walls.
float PatchCover::height(const Prism& prism, const OpenTriangle& open,
                         const PrismPoint& apex) const {
  const float corners = std::max({open.from.height(), open.to.height(), apex.height()});
  if (corners <= prism.limit) return corners;
  const double plane =
      plane_height(surface_.triangle(open.triangle), prism.normal, prism.base) / prism.unit;
  if (plane * (1 + kRounding) <= prism.limit) return static_cast<float>(plane * (1 + kRounding));
  return height_inside(open.from, open.to, apex);
}

// Returns an upper bound of the height of a triangle's part inside the walls. Clips the triangle at
// each wall in turn. Each clip rounds about twelve times.
float PatchCover::height_inside(const PrismPoint& a, const PrismPoint& b, const PrismPoint& c) {
  const float slack = 5 * std::max({a.slack, b.slack, c.slack});
  // Clipping gives at most six corners. Rounding may add a few more.
  std::array<Lanes, 9> polygon{a.at, b.at, c.at}, cut;
  std::size_t size = 3;
  for (std::size_t wall = 1; wall <= 3; ++wall) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const Lanes &p = polygon[i], &q = polygon[i + 1 < size ? i + 1 : 0];
      const float here = p[wall] + slack, there = q[wall] + slack;
      if (here >= 0) cut[kept++] = p;
      if ((here < 0 && there > 0) || (here > 0 && there < 0))
        cut[kept++] = p + (q - p) * (here / (here - there));
    }
    polygon = cut, size = kept;
  }
  float height = 0;
  for (std::size_t i = 0; i < size; ++i)
    height = std::max(height, std::abs(polygon[i][0]));
  return height + slack;
}

// Adds a triangle to the patch. Returns false if the patch can no longer cover the prism's
// triangle.
bool PatchCover::step(const Prism& prism, const OpenTriangle& open) {
  const std::uint32_t t = open.triangle, next = kNext[open.edge], last = kNext[next];
  const PrismPoint &from = open.from, &to = open.to, apex = prism.place(surface_.point(t, last));
  if (((from.bits | to.bits | apex.bits) & kFar) != 0) return false;
  const float high = height(prism, open, apex);
  if (!(high <= prism.limit)) return false;
  height_ = std::max(height_, high);
  const float squared = std::max({from.squared, to.squared, apex.squared});
  if (squared <= prism.limit * prism.limit) {
    marks_[t] = mark_;
    squared_ = std::max(squared_, squared);
  }
  const bool aside = (from.bits & to.bits & apex.bits & kAside) != 0;
  if (!aside && !count(from, to, apex, prism.centre)) return false;
  return cross_edge(prism, t, next, to, apex) && cross_edge(prism, t, last, apex, from);
}

// Adds +1 or -1 to the degree of the patch if the triangle lies over the point `centre`. Returns
// false if rounding makes this uncertain.
bool PatchCover::count(const PrismPoint& a, const PrismPoint& b, const PrismPoint& c,
                       const Lanes& centre) {
  const float one = area(a.at, b.at, centre), two = area(b.at, c.at, centre),
              three = area(c.at, a.at, centre);
  const float least = std::min({one, two, three}), most = std::max({one, two, three});
  const float slack = std::max({a.slack, b.slack, c.slack});
  const float doubt = doubtful_area(slack);
  if (least < -doubt && most > doubt) return true;
  if (least > doubt) return ++degree_, true;
  if (most < -doubt) return --degree_, true;
  return false;
}

// Whether an edge certainly does not reach into the prism: both ends lie beyond the same wall, or
// the whole prism lies on one side of the edge. Only the coordinates at[1] and at[2] of PrismPoint
// are used. In these, the corners a, b and c of the prism's triangle are (0, A), (0, 0) and (A, 0),
// where A is twice the area of that triangle.
bool PatchCover::passes_by(const Prism& prism, const PrismPoint& from, const PrismPoint& to) {
  if ((from.bits & to.bits & kBeyond) != 0) return true;
  const float u = to.at[1] - from.at[1], v = to.at[2] - from.at[2];
  const float second = v * from.at[1] - u * from.at[2];
  const float first = second + u * prism.twice_area, third = second - v * prism.twice_area;
  const float doubt = doubtful_area(std::max(from.slack, to.slack));
  return std::min({first, second, third}) > doubt || std::max({first, second, third}) < -doubt;
}

// Adds the triangle across an edge to the queue if the edge reaches into the prism. Returns false
// if the edge reaches into the prism but is a border edge.
bool PatchCover::cross_edge(const Prism& prism, std::uint32_t triangle, std::uint32_t edge,
                            const PrismPoint& from, const PrismPoint& to) {
  const std::uint32_t other = surface_.across(triangle, edge);
  if (met_[other] == call_ && other != triangle) return true;
  if (passes_by(prism, from, to)) return true;
  if (other == triangle) return false;
  met_[other] = call_;
  open_.push_back({other, surface_.edge_across(triangle, edge), to, from});
  return true;
}

}  // namespace vitrine::inline codec
