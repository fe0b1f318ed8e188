// SPDX-License-Identifier: Apache-2.0
// Connectivity of a closed triangle mesh, as a corner table in flat arrays.
//
// Virtual faces close each boundary loop. They meet at one virtual vertex per loop. Every vertex
// therefore has a full one-ring, and no operation needs a special case for boundaries. Face f has
// the corners 3f, 3f + 1 and 3f + 2, which list its vertices counter-clockwise. An edge of a face
// is identified by the corner opposite to it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/limits.h"
#include "codec/core/segments.h"
#include "codec/core/vec.h"

namespace vitrine::inline codec {

using VertexId = std::uint32_t;
using Corner = std::uint32_t;

// kVirtualBit + k is the virtual vertex that closes boundary loop k.
inline constexpr VertexId kVirtualBit = 0x8000'0000u;
inline constexpr Corner kNoCorner = 0xFFFF'FFFFu;

constexpr bool is_virtual(VertexId v) {
  return (v & kVirtualBit) != 0;
}
// next() and prev() avoid branches, because the remainder of c by 3 is unpredictable.
constexpr Corner next(Corner c) {
  return c + 1 - 3 * static_cast<Corner>(c % 3 == 2);
}
constexpr Corner prev(Corner c) {
  return c - 1 + 3 * static_cast<Corner>(c % 3 == 0);
}

class Connectivity {
 public:
  // Builds the connectivity of `faces` over the vertices [0, vertex_count) and closes the boundary
  // loops. Loops are numbered in the order of their smallest vertices. Fails (kBadInput) unless the
  // following holds; the error names the first offending face:
  // - Every index is in range, and no face repeats a vertex.
  // - Every edge belongs to one face, or to two faces that traverse it in opposite directions.
  // - The faces of every vertex form exactly one fan.
  static Expected<Connectivity> close(std::uint32_t vertex_count, std::span<const Triangle> faces);

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(corner_at_.size()); }
  std::uint32_t loop_count() const { return static_cast<std::uint32_t>(loop_length_.size()); }
  std::uint32_t face_count() const { return static_cast<std::uint32_t>(step_.size() / 3); }

  VertexId vertex(Corner c) const { return step_[prev(c)].to; }
  VertexId neighbour(Corner c) const { return step_[c].to; }  // equals vertex(next(c))
  // Returns the corner opposite to c: the corner of the neighbouring face that lies across the edge
  // opposite to c.
  Corner opposite(Corner c) const { return prev(swing(prev(c))); }
  // Returns one corner of the vertex, or kNoCorner if the vertex was removed.
  Corner corner_at(VertexId real) const { return corner_at_[real]; }
  std::uint32_t loop_length(VertexId virt) const { return loop_length_[virt & ~kVirtualBit]; }
  bool is_dead(std::uint32_t face) const { return step_[3 * face].to == kNoCorner; }
  // Whether the face belongs to the surface. A face with a virtual corner does not: it closes a
  // boundary loop.
  bool is_real(std::uint32_t face) const {
    return !is_virtual(step_[3 * face].to) && !is_virtual(step_[3 * face + 1].to) &&
           !is_virtual(step_[3 * face + 2].to);
  }

  // Returns the next corner at the same vertex, going counter-clockwise.
  Corner swing(Corner c) const { return step_[c].swing; }

  // Writes the corners at `v` to `corners`, counter-clockwise from corner_at(v). Ring vertex i is
  // neighbour(corners[i]). Returns the valence, or 0 if the valence exceeds corners.size().
  std::uint32_t ring(VertexId v, std::span<Corner> corners) const;

  // Splits the vertex v. `corners` is the ring of v, starting at any corner; i and j are different
  // indices into it. The new vertex w = vertex_count() takes the faces from ring vertex i
  // counter-clockwise to ring vertex j. Two new faces are appended: (v, q_i, w), then (v, w, q_j).
  //
  //        q_j                 q_j
  //       / | \               / | \        .
  //      /  |  \             /  |  \       .
  //     ----v----   --->    ---v-w---      (w takes the faces from q_i around to q_j)
  //      \  |  /             \  |  /
  //       \ | /               \ | /
  //        q_i                 q_i
  VertexId split(VertexId v, std::span<const Corner> corners, std::uint32_t i, std::uint32_t j);

  // Collapses an edge; this is the inverse of split(). `c` is the corner of v1 in the face (v1, v2,
  // apex). Removes v2 and the two faces at the edge (v1, v2); v1 remains. The caller must have
  // checked the link condition.
  void collapse(Corner c);

  // Undoes the last split if it split the vertex `v`; otherwise does nothing. Takes time
  // proportional to the valence.
  void unsplit(VertexId v);

  // Appends the components of `part`, which must have no removed faces. The vertices, faces and
  // loops of `part` get the numbers after the existing ones.
  void append(Connectivity part);
  // Removes the newest vertices, faces and loops, as many as the arguments state. The removed
  // elements must be whole components.
  void drop(std::uint32_t vertices, std::uint32_t faces, std::uint32_t loops);
  // Removes `v` and its faces. The mesh is invalid until the whole component has been removed.
  void erase(VertexId v);

 private:
  void set_vertex(Corner c, VertexId v) { step_[prev(c)].to = v; }
  // Records that the corners a and b are opposite to each other.
  void glue(Corner a, Corner b) {
    step_[prev(a)].swing = next(b);
    step_[prev(b)].swing = next(a);
  }
  struct EdgeTable;
  // First step of close(): pairs the two corners that lie opposite to each inner edge, one in each
  // of its two faces. The result has one entry per vertex: the corner opposite to the border edge
  // that leaves the vertex, or kNoCorner if no border edge leaves it.
  Expected<std::vector<Corner>> glue_twins(const EdgeTable& table);
  // Second step of close(): closes each boundary loop with faces that meet at a new virtual vertex.
  Expected<void> close_loops(std::span<const Corner> border);
  // Last step of close(): records one corner of each vertex. Fails unless all faces of each vertex
  // form one fan.
  Expected<void> anchor_fans();

  void add_face(VertexId a, VertexId b, VertexId c);
  void add_valence(VertexId v, int delta);
  void anchor(VertexId v, Corner c);

  // Nearly all operations walk around vertices. A step of such a walk reads two values: the vertex
  // at the other end of the edge, and the next corner at the same vertex. The table stores these
  // two together. It does not store a corner's own vertex and opposite corner, because both follow
  // from the other corners of the face.
  struct Step {
    VertexId to = kNoCorner;  // vertex(next(c)); kNoCorner in a removed face
    Corner swing = kNoCorner;
  };
  Segments<Step> step_;                     // one entry per corner
  Segments<Corner> corner_at_;              // per real vertex: one of its corners
  std::vector<std::uint32_t> loop_length_;  // per virtual vertex: number of edges in its loop
};

}  // namespace vitrine::inline codec
