// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/surface.h"

namespace vitrine::inline codec {
namespace {

constexpr double kBorderWeight = 2;  // weight of a border plane, per squared length of its edge

class Accumulator {
 public:
  Accumulator(const Connectivity& mesh, const PositionOf& position)
      : mesh_(mesh), position_(position), quadric_(mesh.vertex_count()) {}

  std::vector<Quadric> run() && {
    for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) {
      mesh_.is_real(f) ? add_face(3 * f) : add_border(3 * f);
    }
    return std::move(quadric_);
  }

 private:
  Vec3 at(Corner c) const { return position_(mesh_.vertex(c)); }

  Vec3 face_normal(Corner c) const {  // its length is twice the area of the face
    return cross(at(next(c)) - at(c), at(prev(c)) - at(c));
  }

  void add_face(Corner c) {
    const Vec3 normal = face_normal(c);
    const double size = length(normal);
    if (size == 0) return;
    const Quadric q = plane_quadric(normal * (1 / size), at(c), size / 2);
    for (Corner k : {c, next(c), prev(c)})
      quadric_[mesh_.vertex(k)] += q;
  }

  void add_border(Corner c) {
    while (!is_virtual(mesh_.vertex(c)))
      c = next(c);
    const Vec3 edge = at(prev(c)) - at(next(c));
    const Vec3 outward = cross(edge, face_normal(mesh_.opposite(c)));
    const double size = length(outward);
    if (size == 0) return;
    const Quadric q =
        plane_quadric(outward * (1 / size), at(next(c)), kBorderWeight * dot(edge, edge));
    quadric_[mesh_.neighbour(c)] += q;
    quadric_[mesh_.vertex(prev(c))] += q;
  }

  const Connectivity& mesh_;
  const PositionOf& position_;
  std::vector<Quadric> quadric_;
};

}  // namespace

std::vector<Quadric> surface_quadrics(const Connectivity& mesh, const PositionOf& position) {
  return Accumulator(mesh, position).run();
}

}  // namespace vitrine::inline codec
