// SPDX-License-Identifier: Apache-2.0
#include "codec/refine/display_filter.h"

namespace vitrine::inline codec {
namespace {

struct RingShape {
  Vec3 mean;
  Vec3 area;  // area vector of the faces at v; parallel to the vertex normal
  bool closed = true;
};

RingShape shape_of(const MeshState& mesh, VertexId v) {
  RingShape shape;
  const Connectivity& faces = mesh.connectivity;
  const Corner first = faces.corner_at(v);
  const Vec3i& origin = mesh.positions[v];
  int count = 0;
  Corner c = first;
  do {
    const VertexId a = faces.neighbour(c), b = faces.vertex(prev(c));
    if (is_virtual(a) || is_virtual(b)) {
      shape.closed = false;
      return shape;
    }
    const Vec3 p = to_vec3(mesh.positions[a] - origin);
    shape.mean += p;
    shape.area += cross(p, to_vec3(mesh.positions[b] - origin));
    ++count;
    c = faces.swing(c);
  } while (c != first);
  shape.mean = shape.mean * (1.0 / count);
  return shape;
}

}  // namespace

Vec3 display_shift(const MeshState& mesh, VertexId v) {
  const RingShape shape = shape_of(mesh, v);
  const double size = dot(shape.area, shape.area);
  if (!shape.closed || !(size > 0)) return {};
  // `shape.mean` is relative to the position of v.
  return shape.area * (-dot(shape.area, shape.mean) / size);
}

Vec3 display_position(const MeshState& mesh, VertexId v, const LevelInfo& at) {
  const double offset = display_offset(at.shift);
  const Vec3 p = to_vec3(mesh.positions[v]) + Vec3{offset, offset, offset};
  if (mesh.vertex[v].is_border || at.display_filter == 0) return p;
  return p + display_shift(mesh, v) * at.display_filter;
}

}  // namespace vitrine::inline codec
