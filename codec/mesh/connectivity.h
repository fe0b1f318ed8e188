// SPDX-License-Identifier: Apache-2.0
// Half-edge connectivity of a closed triangle mesh in flat arrays (a corner table).
//
// Every boundary loop is closed by one virtual vertex, so that each vertex has a full one-ring and
// no operation has a boundary case. Corner c belongs to face c / 3; the face of the corners
// 3f, 3f+1, 3f+2 lists its vertices counter-clockwise; the edge opposite to a corner is named by
// it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/limits.h"
#include "codec/core/segments.h"
#include "codec/core/vec.h"

namespace vitrine {

using VertexId = std::uint32_t;
using Corner = std::uint32_t;

inline constexpr VertexId kVirtualBit = 0x8000'0000u;  // kVirtualBit + k closes boundary loop k
inline constexpr Corner kNoCorner = 0xFFFF'FFFFu;

constexpr bool is_virtual(VertexId v) {
  return (v & kVirtualBit) != 0;
}
constexpr Corner next(Corner c) {
  return c % 3 == 2 ? c - 2 : c + 1;
}
constexpr Corner prev(Corner c) {
  return c % 3 == 0 ? c + 2 : c - 1;
}

class Connectivity {
 public:
  // Closes `faces` over the vertices [0, vertex_count). Loops are numbered by their smallest
  // vertex. Fails (kBadInput) and names the first offending face unless every index is in range,
  // every edge has one or two faces of opposite direction, every vertex has exactly one fan and no
  // face repeats a vertex.
  static Expected<Connectivity> close(std::uint32_t vertex_count, std::span<const Triangle> faces);

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(corner_at_.size()); }
  std::uint32_t loop_count() const { return static_cast<std::uint32_t>(loop_length_.size()); }
  std::uint32_t face_count() const { return static_cast<std::uint32_t>(step_.size() / 3); }

  VertexId vertex(Corner c) const { return step_[prev(c)].to; }
  VertexId neighbour(Corner c) const { return step_[c].to; }  // vertex(next(c))
  // The corner across c's opposite edge.
  Corner opposite(Corner c) const { return prev(swing(prev(c))); }
  Corner corner_at(VertexId real) const { return corner_at_[real]; }  // kNoCorner where removed
  std::uint32_t loop_length(VertexId virt) const { return loop_length_[virt & ~kVirtualBit]; }
  bool is_dead(std::uint32_t face) const { return step_[3 * face].to == kNoCorner; }
  // A face with a virtual corner closes a boundary loop and is not part of the surface.
  bool is_real(std::uint32_t face) const {
    return !is_virtual(step_[3 * face].to) && !is_virtual(step_[3 * face + 1].to) &&
           !is_virtual(step_[3 * face + 2].to);
  }

  // The next corner at the same vertex, counter-clockwise.
  Corner swing(Corner c) const { return step_[c].swing; }

  // Writes the corners at `v` counter-clockwise, starting at corner_at(v); corner i has
  // neighbour(corner) = the ring's i-th vertex. Returns the valence, or 0 where it exceeds
  // `corners.size()`.
  std::uint32_t ring(VertexId v, std::span<Corner> corners) const;

  // Vertex split. `corners` is the ring of v from any start, i != j positions in it. A new vertex
  // w = vertex_count() takes the faces between ring vertices i and j, counter-clockwise; the two
  // new faces are (v, q_i, w) and (v, w, q_j), appended in this order.
  //
  //        q_j                 q_j
  //       / | \               / | \        .
  //      /  |  \             /  |  \       .
  //     ----v----   --->    ---v-w---      (w takes the faces from q_i round to q_j)
  //      \  |  /             \  |  /
  //       \ | /               \ | /
  //        q_i                 q_i
  VertexId split(VertexId v, std::span<const Corner> corners, std::uint32_t i, std::uint32_t j);

  // Edge collapse, the inverse: `c` is a corner of v1 in the face (v1, v2, apex). v2 and its two
  // faces die, v1 stays. The caller has checked the link condition.
  void collapse(Corner c);

  // Takes back the newest split; v is the vertex that was split. O(valence).
  void unsplit(VertexId v);

  // Adds the components of `part`, of which no face is dead: its vertices, faces and loops are
  // numbered behind those that are there.
  void append(Connectivity part);
  // Takes back the newest vertices, faces and loops, which are whole components.
  void drop(std::uint32_t vertices, std::uint32_t faces, std::uint32_t loops);
  // The faces of `v` die, and v with them; its component is valid again once all of it is gone.
  void erase(VertexId v);

 private:
  void set_vertex(Corner c, VertexId v) { step_[prev(c)].to = v; }
  // Makes a and b opposite.
  void glue(Corner a, Corner b) {
    step_[prev(a)].swing = next(b);
    step_[prev(b)].swing = next(a);
  }
  void add_face(VertexId a, VertexId b, VertexId c);
  void add_valence(VertexId v, int delta);
  void anchor(VertexId v, Corner c);

  // Walks round vertices are what all work consists of. The table has what a step of one reads,
  // side by side: the vertex at the other end of the edge and the next corner; not the corner's own
  // vertex, nor the opposite corner, which would be one and two turns within a face.
  struct Step {
    VertexId to = kNoCorner;  // that of next(c); kNoCorner in all three where the face is dead
    Corner swing = kNoCorner;
  };
  Segments<Step> step_;                     // per corner
  Segments<Corner> corner_at_;              // per real vertex
  std::vector<std::uint32_t> loop_length_;  // per virtual vertex
};

}  // namespace vitrine
