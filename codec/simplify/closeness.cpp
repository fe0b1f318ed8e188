// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/closeness.h"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <span>

#include "codec/mesh/closest_point.h"

namespace vitrine {
namespace {

// A star and where its real neighbours are.
struct Ring {
  Ring(const Surface& surface, const Star& around) : star(around) {
    for (const VertexId v : star.neighbours())
      point.push_back(is_virtual(v) ? Vec3{} : surface.point(v));
  }

  const Star& star;
  boost::container::static_vector<Vec3, Star::kCapacity> point;
};

// The faces around an edge, before or after it has collapsed.
class Patch {
 public:
  // A ring around a place, but for what is at the vertex `without`.
  struct Part {
    const Ring& ring;
    Vec3 centre;
    VertexId without;
  };
  Patch(const Part& one, const Part& two) {
    add(one);
    start_[1] = size();
    add(two);
  }

  std::span<const Corners> faces() const { return face_; }

  // Points come in the order of the faces, so that the search goes on where the last one ended.
  bool is_near(const Vec3& p, double squared) {
    for (std::uint32_t i = 0; i < size(); ++i) {
      if (squared_distance(face_[last_], p) <= squared) return true;
      last_ = last_ + 1 < size() ? last_ + 1 : 0;
    }
    return false;
  }

  // The middles of a ring's edges. `part`: the ring's own.
  bool has_near(const Part& edges, std::uint32_t part, double squared) {
    last_ = start_[part] < size() ? start_[part] : 0;  // where that part has no faces
    for (std::uint32_t i = 0; i < edges.ring.star.valence; ++i) {
      const VertexId v = edges.ring.star.vertex[i];
      if (v == edges.without || is_virtual(v)) continue;
      if (!is_near((edges.centre + edges.ring.point[i]) * 0.5, squared)) return false;
    }
    return true;
  }

  // The middles of the faces of another patch.
  bool has_near(const Patch& other, double squared) {
    last_ = 0;
    return std::ranges::all_of(other.faces(), [&](const Corners& f) {
      return is_near((f.a + f.b + f.c) * (1.0 / 3), squared);
    });
  }

 private:
  std::uint32_t size() const { return static_cast<std::uint32_t>(face_.size()); }

  void add(const Part& part) {
    const Star& star = part.ring.star;
    std::uint32_t i = star.valence - 1;
    for (std::uint32_t j = 0; j < star.valence; i = j++) {
      const VertexId v = star.vertex[i], w = star.vertex[j];
      if (is_virtual(v) || is_virtual(w) || v == part.without || w == part.without) continue;
      face_.push_back({part.centre, part.ring.point[i], part.ring.point[j]});
    }
  }

  boost::container::static_vector<Corners, 2 * Star::kCapacity> face_;
  std::array<std::uint32_t, 2> start_{};  // of each part
  std::uint32_t last_ = 0;
};

// True if two patches with the same boundary lie in a thin slab and face one way. Then each covers
// a point of the slab's plane as often as their boundary winds around it, and where one of them is
// the other is straight above or below.
bool share_slab(const Patch& one, const Patch& other, double thickness) {
  Vec3 normal;
  for (const Corners& t : one.faces())
    normal += normal_of(t);
  const Vec3 origin = one.faces()[0].a;
  double low = 0, high = 0;
  for (const Patch* patch : {&one, &other}) {
    for (const Corners& t : patch->faces()) {
      if (dot(normal_of(t), normal) <= 0) return false;
      for (const Vec3& p : {t.a, t.b}) {  // the next face around the centre has the third
        const double height = dot(p - origin, normal);
        low = std::min(low, height), high = std::max(high, height);
      }
    }
  }
  return (high - low) * (high - low) <= thickness * thickness * dot(normal, normal);
}

}  // namespace

bool keeps_near(const Surface& surface, const EdgeStar& edge, const Vec3i& target, double reach) {
  const Vec3 p1 = surface.point(edge.v1), p2 = surface.point(edge.v2), to = surface.middle(target);
  const Ring ring1(surface, edge.star1), ring2(surface, edge.star2);
  Patch after({ring1, to, edge.v2}, {ring2, to, edge.v1});
  Patch before({ring1, p1, edge.v1}, {ring2, p2, edge.v1});  // the faces at the edge: in ring1
  if (after.faces().empty()) return false;
  const bool inside = !edge.star1.on_border && !edge.star2.on_border;
  if (inside && share_slab(after, before, reach)) return true;
  const double squared = reach * reach;
  if (!after.is_near(p1, squared) || !after.is_near(p2, squared)) return false;
  // Edges that go and come in pairs are half as far apart as their ends.
  const auto move = [&](const Patch::Part& from, std::uint32_t part, VertexId other) {
    return length(to - from.centre) <= 2 * reach ||
           (after.has_near(from, part, squared) &&
            before.has_near({from.ring, to, other}, part, squared));
  };
  return move({ring1, p1, edge.v1}, 0, edge.v2) && move({ring2, p2, edge.v2}, 1, edge.v1) &&
         before.has_near(after, squared);
}

}  // namespace vitrine
