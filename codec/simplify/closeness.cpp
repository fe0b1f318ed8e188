// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/closeness.h"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <span>

#include "codec/mesh/closest_point.h"

namespace vitrine::inline codec {
namespace {

// The one-ring of a vertex, with the positions of its neighbours. Virtual neighbours have the
// position (0, 0, 0).
struct StarGeometry {
  StarGeometry(const Surface& surface, const Star& around) : star(around) {
    for (const VertexId v : star.neighbours())
      point.push_back(is_virtual(v) ? Vec3{} : surface.point(v));
  }

  const Star& star;
  boost::container::static_vector<Vec3, Star::kCapacity> point;
};

// The faces around an edge, either before its collapse or after it.
class Patch {
 public:
  // The faces between the point `centre` and a ring. Faces with the vertex `without` or a virtual
  // vertex are left out.
  struct Fan {
    const StarGeometry& ring;
    Vec3 centre;
    VertexId without;
  };
  Patch(const Fan& one, const Fan& two) {
    add(one);
    start_[1] = size();
    add(two);
  }

  std::span<const TrianglePoints> faces() const { return face_; }

  // Whether the squared distance from `p` to some face of the patch is at most `squared`. Callers
  // pass points in the order of the faces, so each search starts at the face where the previous
  // search ended.
  bool is_near(const Vec3& p, double squared) {
    for (std::uint32_t i = 0; i < size(); ++i) {
      if (squared_distance(face_[last_], p) <= squared) return true;
      last_ = last_ + 1 < size() ? last_ + 1 : 0;
    }
    return false;
  }

  // Whether is_near() holds for the midpoints of the edges from `edges.centre` to its ring. `fan`
  // is the index of the fan in this patch that has the same ring.
  bool has_near(const Fan& edges, std::uint32_t fan, double squared) {
    last_ = start_[fan] < size() ? start_[fan] : 0;  // 0 if the fan has no faces
    for (std::uint32_t i = 0; i < edges.ring.star.valence; ++i) {
      const VertexId v = edges.ring.star.vertex[i];
      if (v == edges.without || is_virtual(v)) continue;
      if (!is_near((edges.centre + edges.ring.point[i]) * 0.5, squared)) return false;
    }
    return true;
  }

  // Whether is_near() holds for the centroids of all faces in `other`.
  bool has_near(const Patch& other, double squared) {
    last_ = 0;
    return std::ranges::all_of(other.faces(), [&](const TrianglePoints& f) {
      return is_near((f.a + f.b + f.c) * (1.0 / 3), squared);
    });
  }

 private:
  std::uint32_t size() const { return static_cast<std::uint32_t>(face_.size()); }

  void add(const Fan& fan) {
    const Star& star = fan.ring.star;
    std::uint32_t i = star.valence - 1;
    for (std::uint32_t j = 0; j < star.valence; i = j++) {
      const VertexId v = star.vertex[i], w = star.vertex[j];
      if (is_virtual(v) || is_virtual(w) || v == fan.without || w == fan.without) continue;
      face_.push_back({fan.centre, fan.ring.point[i], fan.ring.point[j]});
    }
  }

  boost::container::static_vector<TrianglePoints, 2 * Star::kCapacity> face_;
  std::array<std::uint32_t, 2> start_{};  // per fan: index of its first face
  std::uint32_t last_ = 0;
};

// Whether two patches with the same boundary lie in a thin slab and all their faces point to the
// same side. If so, both patches cover each point of the slab's plane equally often, namely as
// often as their common boundary winds around the point. Each patch therefore lies straight above
// or below the other patch.
bool share_slab(const Patch& one, const Patch& other, double thickness) {
  Vec3 normal;
  for (const TrianglePoints& t : one.faces())
    normal += normal_of(t);
  const Vec3 origin = one.faces()[0].a;
  double low = 0, high = 0;
  for (const Patch* patch : {&one, &other}) {
    for (const TrianglePoints& t : patch->faces()) {
      if (dot(normal_of(t), normal) <= 0) return false;
      // t.c needs no check of its own, because it is t.b of another face of the patch.
      for (const Vec3& p : {t.a, t.b}) {
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
  const StarGeometry ring1(surface, edge.star1), ring2(surface, edge.star2);
  Patch after({ring1, to, edge.v2}, {ring2, to, edge.v1});
  // The two faces at the edge belong to the first fan. The second fan leaves them out, so that they
  // are not counted twice.
  Patch before({ring1, p1, edge.v1}, {ring2, p2, edge.v1});
  if (after.faces().empty()) return false;
  const bool inside = !edge.star1.is_on_border && !edge.star2.is_on_border;
  if (inside && share_slab(after, before, reach)) return true;
  const double squared = reach * reach;
  if (!after.is_near(p1, squared) || !after.is_near(p2, squared)) return false;
  // If an end of the edge moves by at most 2 * reach, the midpoints of its edges move by at most
  // `reach`, so they need no check.
  const auto move = [&](const Patch::Fan& from, std::uint32_t fan, VertexId other) {
    return length(to - from.centre) <= 2 * reach ||
           (after.has_near(from, fan, squared) &&
            before.has_near({from.ring, to, other}, fan, squared));
  };
  return move({ring1, p1, edge.v1}, 0, edge.v2) && move({ring2, p2, edge.v2}, 1, edge.v1) &&
         before.has_near(after, squared);
}

}  // namespace vitrine::inline codec
