// SPDX-License-Identifier: Apache-2.0
// The mesh during refinement. Encoder and decoder have identical states.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/coding/wedges.h"
#include "codec/core/segments.h"
#include "codec/format/base_mesh.h"
#include "codec/format/cell.h"
#include "codec/format/chunk_frame.h"
#include "codec/mesh/connectivity.h"

namespace vitrine::inline codec {

inline constexpr std::uint16_t kNoRegion = 0xFFFF;  // region of a virtual vertex

inline constexpr std::int32_t kCoordinateBound = 1 << 18;  // largest absolute value of a coordinate

constexpr bool is_in_coordinate_bound(const Vec3i& p) {
  const auto ok = [](std::int32_t c) { return c >= -kCoordinateBound && c <= kCoordinateBound; };
  return ok(p.x) && ok(p.y) && ok(p.z);
}

// The data of a vertex other than its position and attributes.
struct VertexRecord {
  // These two numbers identify the vertex: it was the `ordinal`-th new vertex of the region
  // `origin`. They depend neither on the order of refinement nor on which regions have forked.
  std::uint32_t ordinal = 0;
  std::uint16_t origin = 0;
  std::uint16_t region = 0;               // first leaf of the vertex's region (region_tree.h)
  std::uint32_t split_of = 0xFFFF'FFFFu;  // index of the vertex's last split within its chunk
  std::uint8_t split_level = 0;           // level of the vertex's last split
  std::uint8_t visited_level = 0;         // last level in which the vertex was visited
  std::uint8_t valence = 0;               // values above 255 are stored as 255
  bool is_border = false;                 // whether a neighbour belongs to another region
};
static_assert(sizeof(VertexRecord) == 16, "there is one for each vertex of a model");

// A whole component inserted by a chunk. It has at most kMostInserted vertices.
struct InsertedComponent {
  std::uint8_t vertices = 0;
  std::uint8_t faces = 0;  // includes faces that close boundary loops
  std::uint8_t real_faces = 0;
  std::uint8_t loops = 0;
};

struct MeshState {
  // Returns the state at level 0, with a single region that has `leaves` leaves. The positions of
  // `base` are cells (cell.h) with sides of 2^shift. Fails if the base mesh is not a manifold or a
  // coordinate is out of bounds.
  static Expected<MeshState> from_base(const BaseMesh& base, std::uint32_t shift,
                                       std::uint32_t leaves);

  Connectivity connectivity;
  Segments<Vec3i> positions;
  AttributeColumns<Segments<Vec3i>> attributes;
  Segments<VertexRecord> vertex;
  Wedges wedges;  // empty if the model has no texture

  std::vector<std::vector<VertexId>> members;  // per region: its vertices, in ascending order
  std::vector<std::uint32_t> ordinals;         // per region: number of vertices created so far

  // Lattice shifts of the last decoded chunk. Positions in the chunk's region are centres of cells
  // with sides of 2^shift. Positions in other regions are rounded to the previous level's cells,
  // with sides of 2^foreign_shift.
  std::uint32_t shift = 0, foreign_shift = 0;

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(positions.size()); }
  // Returns the position of v that a chunk of region `from` uses. The result does not depend on
  // whether v's region has already reached the chunk's level. v must not be virtual.
  Vec3i seen_from(std::uint16_t from, VertexId v) const {
    if (vertex[v].region == from) return positions[v];
    return middle_of(cell_of(positions[v], foreign_shift), foreign_shift);
  }
  std::uint16_t region_of(VertexId v) const { return is_virtual(v) ? kNoRegion : vertex[v].region; }
  std::uint64_t canonical(VertexId v) const {
    if (is_virtual(v)) return std::uint64_t{v} << 32 | v;
    return std::uint64_t{vertex[v].origin} << 32 | vertex[v].ordinal;
  }

  // Appends whole components to region k at `level`. `part` must have the same attributes as the
  // mesh and no faces at virtual vertices. Its positions are cells with sides of 2^shift. Fails
  // like from_base(); the state is then unchanged.
  Expected<void> add(const BaseMesh& part, std::uint16_t k, std::uint8_t level);
  // Undoes the last add(). The state must be the same as directly after add().
  void remove(const InsertedComponent& newest);

  // Prefetches the one-rings of the next vertices in `order`, eight at a time, so that visits do
  // not wait for memory. Call this before each visit to vertex order[k].
  void fetch_rings(std::span<const VertexId> order, std::size_t k) const;

  void count_valence(VertexId v);
  // Appends position, record and attributes for the new vertex that was split from `v`.
  void inherit(VertexId v);
  // Removes the position, record and attributes of the newest vertex. Call this after
  // Connectivity::unsplit().
  void disinherit();
  // Sets `is_border` of v from its one-ring. v must not be virtual.
  void mark_border(VertexId v);

  std::uint32_t real_face_count() const;
  std::vector<Triangle> real_faces() const;
};

}  // namespace vitrine::inline codec
