// SPDX-License-Identifier: Apache-2.0
// A model in the browser: its manifest, the surface refined so far, and a planner for the current
// detail target.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/segments.h"
#include "codec/format/base_mesh.h"
#include "codec/format/manifest.h"
#include "codec/plan/planner.h"
#include "codec/refine/refiner.h"

namespace vitrine::inline codec {

class BrowserModel {
 public:
  static Expected<std::unique_ptr<BrowserModel>> open(std::span<const std::uint8_t> header);
  explicit BrowserModel(std::shared_ptr<const Manifest> manifest);
  // Not copyable, because the planner holds references to members of this object.
  BrowserModel(const BrowserModel&) = delete;
  BrowserModel& operator=(const BrowserModel&) = delete;

  const Manifest& manifest() const { return *manifest_; }

  // These functions fail (kBadInput) if the SHA-256 of `bytes` differs from that in the manifest.
  Expected<void> check_base(std::span<const std::uint8_t> bytes) const;
  Expected<void> check_atlas(std::span<const std::uint8_t> bytes) const;
  Expected<void> check_chunk(std::size_t chunk, std::span<const std::uint8_t> bytes) const;
  Expected<void> check_picture(std::size_t picture, std::span<const std::uint8_t> bytes) const;

  // Starts at the base mesh. `atlas` holds the coded texture coordinates of the base mesh, and is
  // empty if the model has no texture. Keeps copies of both, because a coarser state can only be
  // reached by restarting from the base mesh.
  Expected<void> start(BaseMesh base, std::span<const std::uint8_t> atlas = {});

  // Sets the detail target. Call this after start(). If the surface is finer than the target,
  // restarts from the base mesh and returns true.
  Expected<bool> want(std::uint32_t kind, double value);
  Expected<bool> want(const Want& goal);
  Expected<bool> want(const View& view, double most_triangles);
  int next_chunk();  // next chunk to request; -1 if the detail target is reached
  Expected<void> apply(std::size_t chunk, std::span<const std::uint8_t> bytes);
  void trim();
  double bytes_held() const;

  const Refiner& refiner() const { return *refiner_; }

  // Number of displayed vertices. If the model has a texture, these are the wedges: a vertex of the
  // mesh is displayed once for each of its wedges.
  std::uint32_t displayed_vertices() const;
  // `v` is a displayed vertex. Returns the displayed vertex that the last applied chunk split to
  // create v, or v itself if that chunk did not create v by a split.
  VertexId parent_of(VertexId v) const;

  // The displayed surface is returned in pieces, which saves a second copy of the surface. Call
  // display() first. Each call of next_vertices() or next_faces() then fills the arrays below with
  // the next displayed vertices or faces, and returns their number, or 0 at the end.
  static constexpr std::uint32_t kPiece = 4096;  // maximum number of vertices or faces per piece
  void display();
  std::uint32_t next_vertices();
  std::uint32_t next_faces();
  const std::vector<std::array<float, 3>>& positions() const { return positions_; }
  const std::vector<std::array<std::int16_t, 4>>& normals() const { return normals_; }
  const VertexAttributes& attributes() const { return attributes_; }
  const std::vector<Vec3i>& lattice_positions() const { return lattice_positions_; }
  // Texture coordinates of the displayed vertices, from (0, 0) in the upper left corner of the
  // pictures to (1, 1) in the lower right corner. Empty if the model has no texture.
  const std::vector<std::array<float, 2>>& coordinates() const { return coordinates_; }
  const std::vector<Triangle>& faces() const { return faces_; }

  // Returns the manifest as numbers:
  //  [0] levels, [1] chunks, [2] base offset, [3] base length, [4] file bytes,
  //  [5] attributes (one bit per semantic), [6] lattice bits, [7] lattice step, [8..10] centre;
  //  per level: vertices, faces, max error, rms error, cumulative bytes;
  //  per chunk: level, region, offset, length;
  //  if the model has a texture: atlas offset, atlas length, alpha mode, alpha cutoff,
  //  1 if double-sided, 1 if unlit, number of pictures, number of pictures in the file's head;
  //  per picture: role, side, offset, length.
  const std::vector<double>& summary();

 private:
  Expected<void> restart();
  Expected<bool> pursue(const Want& goal, bool back);
  bool exceeds(const Want& goal) const;  // whether the surface is finer than `goal` anywhere
  bool is_textured() const { return !refiner_->wedges().empty(); }
  Vec3 shown(VertexId v) const;
  Vec3 normal(VertexId v) const;
  void add_vertex(VertexId v);
  void add_wedge(const Wedge& wedge);
  void summarise_texture();

  std::shared_ptr<const Manifest> manifest_;
  BaseMesh base_;
  Vec3 centre_;  // centre of the base mesh's bounding box, in lattice units
  std::optional<Refiner> refiner_;
  std::optional<Planner> planner_;
  std::optional<std::uint32_t> triangles_;  // set if the detail target is a number of triangles
  double most_triangles_ = 0;               // maximum number of triangles if the target is a view
  std::vector<std::uint8_t> applied_;
  bool needs_restart_ = false;  // if true, apply() fails until restart()

  std::vector<double> summary_;
  // Displayed positions of all vertices of the mesh, in lattice units, relative to centre_.
  Segments<std::array<float, 3>> shown_;
  VertexId vertices_out_ = 0;    // number of displayed vertices returned since display()
  std::uint32_t faces_out_ = 0;  // faces of connectivity() visited since display()
  std::vector<std::array<float, 3>> positions_;
  std::vector<std::array<std::int16_t, 4>> normals_;
  VertexAttributes attributes_;
  std::vector<Vec3i> lattice_positions_;
  std::vector<std::array<float, 2>> coordinates_;
  std::vector<Triangle> faces_;
};

}  // namespace vitrine::inline codec
