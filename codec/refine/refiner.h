// SPDX-License-Identifier: Apache-2.0
// Refines a base mesh chunk by chunk. The chunk of level l and region k can be applied once k and
// all adjacent regions have level l - 1. Every order that obeys this rule gives the same final
// mesh. Every intermediate state is a valid manifold without cracks.
//
// Safe on hostile bytes: a damaged chunk gives an error or a valid mesh. After an error, apply()
// always fails with kState. The refiner can then only be destroyed.
//
// A refiner uses at most 60 bytes per triangle of the current closed mesh (64 with colours, and 32
// more with texture coordinates), 1 KiB per region, 8 bytes per byte of the header (for its
// adjacency and chunk index) and 512 KiB. A chunk of n bytes adds at most 16 * n + 256 vertices
// (most_new_vertices()). Its splits add at most one vertex per existing vertex. An inserted
// component has at most two faces per vertex. Arrays grow in blocks of 2,048 elements, so a split
// allocates nothing of its own. If memory runs out, start() and apply() throw std::bad_alloc; a
// refiner that threw can only be destroyed or replaced.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "codec/coding/wedges.h"
#include "codec/core/expected.h"
#include "codec/core/segments.h"
#include "codec/format/base_mesh.h"
#include "codec/format/manifest.h"
#include "codec/mesh/connectivity.h"
#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

class Refiner {
 public:
  // Returns a refiner at level 0. If `base` has no atlas, the refiner keeps no texture coordinates,
  // even if the model has a texture. `base` holds the surface faces decoded from the Draco buffer;
  // its positions are cells of level 0 (cell.h). Fails (kBadInput) if `base` is not a manifold or
  // its counts differ from those of level 0 in the manifest.
  static Expected<Refiner> start(std::shared_ptr<const Manifest> manifest, const BaseMesh& base);
  static Expected<Refiner> start(Manifest manifest, const BaseMesh& base) {
    return start(std::make_shared<const Manifest>(std::move(manifest)), base);
  }
  Refiner(Refiner&&) noexcept;
  Refiner& operator=(Refiner&&) noexcept;
  ~Refiner();

  const Manifest& manifest() const;
  bool is_applied(std::size_t chunk) const;
  bool is_ready(std::size_t chunk) const;  // whether apply(chunk) is allowed now

  // Applies manifest().chunks[chunk]; `bytes` is the chunk's content. Fails with kState unless
  // is_ready(chunk). If the bytes are untrusted, the caller must check their SHA-256 first.
  Expected<void> apply(std::size_t chunk, std::span<const std::uint8_t> bytes);

  // Undoes part of the last applied chunk, to show an intermediate state of a level. Undoes the
  // chunk's component insertions first, then its splits, last split first. Stops once at most
  // `faces` real faces are left, or the whole chunk is undone. No chunk can be applied afterwards.
  void undo_to_faces(std::uint32_t faces) noexcept;

  std::uint32_t vertex_count() const;        // without virtual vertices
  std::uint32_t face_count() const;          // without virtual faces
  std::uint32_t level_of(VertexId v) const;  // the current level of v's region
  // Returns the number of the first leaf of v's region (region_tree.h).
  std::uint32_t region_of(VertexId v) const;
  // Returns the vertex that the last applied chunk split to create v. Returns v itself if that
  // chunk did not create v by a split.
  VertexId parent_of(VertexId v) const;

  // The coded surface, in lattice units. connectivity() has no removed elements. Faces with a
  // virtual corner (is_virtual) close boundary loops and do not belong to the surface.
  const Connectivity& connectivity() const;
  const Segments<Vec3i>& positions() const;
  // One column for each attribute that the manifest lists, as integers (lattice_attributes.h).
  const AttributeColumns<Segments<Vec3i>>& attributes() const;

  // The texture coordinates of all face corners, as integers. A picture is TextureInfo::side units
  // wide and high. Empty if the base mesh had no atlas.
  const Wedges& wedges() const;
  // Returns the texture coordinates of each surface face, in the order of lattice_mesh().faces.
  std::vector<std::array<TextureCoordinates, 3>> texture_coordinates() const;

  // Returns the position at which v is displayed and exported: after the display filter, in lattice
  // units (codec/FORMAT.md section 7). Equals positions()[v] at full resolution.
  Vec3 display_position(VertexId v) const;

  LatticeMesh lattice_mesh() const;   // exact positions; real faces only
  TriangleMesh display_mesh() const;  // filtered positions in model units; real faces only

 private:
  struct State;
  explicit Refiner(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace vitrine::inline codec
