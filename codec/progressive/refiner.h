// SPDX-License-Identifier: Apache-2.0
// Applies enhancement layers to a base mesh. Chunk (level l, region k) can be applied once level
// l-1 is present in k and in every region adjacent to k; every order that obeys this ends in the
// same mesh, and every state on the way is a valid, crack-free manifold.
//
// Contract: safe on hostile bytes. A damaged chunk gives an error or a valid mesh, and after an
// error the refiner is unusable (`apply` keeps failing with kState) but its memory is in order.
// It holds, at every moment, at most 60 bytes per triangle of the closed mesh at hand (64 with
// colours), 1 KiB per region, 8 bytes per byte of the header (its adjacency and chunk index) and
// 512 KiB; a chunk brings at most 16 vertices per byte and 256 more (most_born), by splits at most
// one per vertex that was there, and a component that is born whole has at most two faces per
// vertex. Nothing is allocated per split: arrays grow by blocks of 2,048 elements. Where memory
// runs out, start() and apply() throw std::bad_alloc, and a refiner that threw can only be
// destroyed or replaced.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "codec/core/expected.h"
#include "codec/core/segments.h"
#include "codec/mesh/connectivity.h"
#include "codec/mesh/triangle_mesh.h"
#include "codec/progressive/base_mesh.h"
#include "codec/progressive/manifest.h"

namespace vitrine {

class Refiner {
 public:
  // `base` holds the real faces as the Draco buffer decodes them, positions in cells of level 0
  // (cell.h). Its counts must equal the manifest's level 0 (kBadInput).
  static Expected<Refiner> start(std::shared_ptr<const Manifest> manifest, const BaseMesh& base);
  static Expected<Refiner> start(Manifest manifest, const BaseMesh& base) {
    return start(std::make_shared<const Manifest>(std::move(manifest)), base);
  }
  Refiner(Refiner&&) noexcept;
  Refiner& operator=(Refiner&&) noexcept;
  ~Refiner();

  const Manifest& manifest() const;
  bool applied(std::size_t chunk) const;
  bool ready(std::size_t chunk) const;  // not applied yet, and all it needs is present

  // Decodes and applies manifest().chunks[chunk]. The caller has checked the SHA-256 where the
  // bytes come from outside.
  Expected<void> apply(std::size_t chunk, std::span<const std::uint8_t> bytes);

  // Takes back components born in the chunk applied last and then its splits, newest first, until
  // at most `faces` real faces are left or all are undone: a level can so be shown in part. No
  // chunk can be applied afterwards.
  void undo_to_faces(std::uint32_t faces) noexcept;

  std::uint32_t vertex_count() const;         // real vertices
  std::uint32_t face_count() const;           // real faces
  std::uint32_t level_of(VertexId v) const;   // level that the vertex' region has reached
  std::uint32_t region_of(VertexId v) const;  // the first leaf of its region (region_tree.h)
  // Whose split by the chunk applied last brought v; v itself where none did.
  VertexId parent_of(VertexId v) const;

  // The surface as coded: lattice units. All slots of `connectivity()` are live; faces with a
  // virtual corner (is_virtual) close boundary loops and are not part of the surface.
  const Connectivity& connectivity() const;
  const Segments<Vec3i>& positions() const;
  const Segments<Vec3i>& colours() const;  // YCoCg-R (colour.h); empty where the model has none

  // Where a vertex is displayed and exported: the display filter applied, lattice units (DESIGN
  // section 2). Equal to positions() at full resolution.
  Vec3 display_position(VertexId v) const;

  LatticeMesh lattice_mesh() const;   // exact, real faces only
  TriangleMesh display_mesh() const;  // filtered, model units, real faces only

 private:
  struct State;
  explicit Refiner(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace vitrine
