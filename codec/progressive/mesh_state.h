// SPDX-License-Identifier: Apache-2.0
// The mesh while it is refined, as encoder and decoder both hold it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/segments.h"
#include "codec/mesh/connectivity.h"
#include "codec/progressive/base_mesh.h"
#include "codec/progressive/cell.h"

namespace vitrine {

inline constexpr std::uint16_t kNoRegion = 0xFFFF;  // of virtual vertices

inline constexpr std::int32_t kCoordinateBound = 1 << 18;  // of every coordinate, +-

constexpr bool in_coordinate_bound(const Vec3i& p) {
  const auto ok = [](std::int32_t c) { return c >= -kCoordinateBound && c <= kCoordinateBound; };
  return ok(p.x) && ok(p.y) && ok(p.z);
}

// What is known of a vertex besides where it is.
struct VertexRecord {
  // A vertex is for ever known as the `birth`-th one born in the region `born_in`. So it does not
  // depend on the order in which regions are refined, nor on which of them have forked.
  std::uint32_t birth = 0;
  std::uint16_t born_in = 0;
  std::uint16_t region = 0;               // its first leaf (region_tree.h)
  std::uint32_t split_of = 0xFFFF'FFFFu;  // index of its split in the chunk that holds that
  std::uint8_t split_level = 0;           // level of its last split
  std::uint8_t visited_level = 0;         // level in which it was last visited
  std::uint8_t valence = 0;               // saturates at 255
  bool border = false;                    // a neighbour is of another region
};
static_assert(sizeof(VertexRecord) == 16, "there is one for each vertex of a model");

// A component that was born whole in a chunk: at most kMostNewborn vertices.
struct Newborn {
  std::uint8_t vertices = 0;
  std::uint8_t faces = 0;  // those that close its boundary loops included
  std::uint8_t real_faces = 0;
  std::uint8_t loops = 0;
};

inline constexpr std::uint32_t kMostNewborn = 64;

struct MeshState {
  // One region of `leaves` leaves, level 0. `base` holds the cells (cell.h) of a level with
  // `shift`. Fails where the base is not a manifold or leaves the bound.
  static Expected<MeshState> from_base(const BaseMesh& base, std::uint32_t shift,
                                       std::uint32_t leaves);

  Connectivity connectivity;
  Segments<Vec3i> positions;
  Segments<Vec3i> colours;  // YCoCg-R, or empty
  Segments<VertexRecord> vertex;

  std::vector<std::vector<VertexId>> members;  // per region: its vertices, ascending
  std::vector<std::uint32_t> born;             // per region: vertices so far

  // Of the chunk decoded last: positions of its region are middles of cells of 2^shift, those of
  // other regions count as far as they are known at the level before, 2^foreign_shift.
  std::uint32_t shift = 0, foreign_shift = 0;

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(positions.size()); }
  // A real vertex as a chunk of region `from` may see it, whether or not its own region has reached
  // the chunk's level.
  Vec3i seen_from(std::uint16_t from, VertexId v) const {
    if (vertex[v].region == from) return positions[v];
    return middle_of(cell_of(positions[v], foreign_shift), foreign_shift);
  }
  std::uint16_t region_of(VertexId v) const { return is_virtual(v) ? kNoRegion : vertex[v].region; }
  std::uint64_t canonical(VertexId v) const {
    if (is_virtual(v)) return std::uint64_t{v} << 32 | v;
    return std::uint64_t{vertex[v].born_in} << 32 | vertex[v].birth;
  }

  // Appends whole components of region k that are new in `level`: real faces, cells of 2^shift, and
  // colours where the mesh has them. Fails as from_base() does, and then changes nothing.
  Expected<void> add(const BaseMesh& part, std::uint16_t k, std::uint8_t level);
  // Takes back what add() brought last and nothing has changed since.
  void remove(const Newborn& newest);

  // For a visit of `order` that has come to its k-th vertex: has the one-rings of those that come
  // soon brought near, several at a time, so that the visits need not wait for each.
  void fetch_rings(std::span<const VertexId> order, std::size_t k) const;

  void count_valence(VertexId v);
  // Appends what the vertex that was split off `v` inherits from it.
  void inherit(VertexId v);
  // Takes the newest vertex back (after Connectivity::unsplit).
  void disinherit();
  // Sets `border` of a real vertex from its one-ring.
  void mark_border(VertexId v);

  std::uint32_t real_face_count() const;
  std::vector<Triangle> real_faces() const;
  std::vector<Colour> display_colours() const;  // sRGB, or empty
};

}  // namespace vitrine
