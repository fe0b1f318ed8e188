// SPDX-License-Identifier: Apache-2.0
// One model in the browser: its manifest, the surface refined so far, and a planner for the current
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
  // Not copyable, because the planner points into this object.
  BrowserModel(const BrowserModel&) = delete;
  BrowserModel& operator=(const BrowserModel&) = delete;

  const Manifest& manifest() const { return *manifest_; }

  // Both functions fail (kBadInput) if the SHA-256 of `bytes` differs from the one in the manifest.
  Expected<void> check_base(std::span<const std::uint8_t> bytes) const;
  Expected<void> check_chunk(std::size_t chunk, std::span<const std::uint8_t> bytes) const;

  // Starts at the base mesh. Keeps `base`, because coarser states are reached by restarting from
  // it.
  Expected<void> start(BaseMesh base);

  // Sets the detail target. Call this after start(). If the surface is finer than the target,
  // restarts from the base mesh and returns true.
  Expected<bool> want(std::uint32_t kind, double value);
  Expected<bool> want(const Want& goal);
  Expected<bool> want(const View& view, double most_triangles);
  int next_chunk();  // returns the next chunk to request, or -1 if the detail target is reached
  Expected<void> apply(std::size_t chunk, std::span<const std::uint8_t> bytes);
  void trim();
  double bytes_held() const;

  const Refiner& refiner() const { return *refiner_; }

  // The displayed surface is returned in pieces, which avoids a second copy. Call display() first.
  // Then each call of next_vertices() or next_faces() fills the arrays below with the next vertices
  // or faces. Both return the number of vertices or faces in the arrays, or 0 at the end.
  static constexpr std::uint32_t kPiece = 4096;  // maximum number of vertices or faces in a piece
  void display();
  std::uint32_t next_vertices();
  std::uint32_t next_faces();
  const std::vector<std::array<float, 3>>& positions() const { return positions_; }
  const std::vector<std::array<std::int16_t, 4>>& normals() const { return normals_; }
  const VertexAttributes& attributes() const { return attributes_; }
  const std::vector<Vec3i>& lattice_positions() const { return lattice_positions_; }
  const std::vector<Triangle>& faces() const { return faces_; }

  // Returns the manifest as numbers:
  //  [0] levels, [1] chunks, [2] base offset, [3] base length, [4] file bytes,
  //  [5] attributes (one bit per semantic), [6] lattice bits, [7] lattice step, [8..10] centre;
  //  per level: vertices, faces, max error, rms error, cumulative bytes;
  //  per chunk: level, region, offset, length.
  const std::vector<double>& summary();

 private:
  Expected<void> restart();
  Expected<bool> pursue(const Want& goal, bool back);
  bool exceeds(const Want& goal) const;  // whether the surface is finer than the goal anywhere
  Vec3 shown(VertexId v) const;
  Vec3 normal(VertexId v) const;
  void add_vertex(VertexId v);

  std::shared_ptr<const Manifest> manifest_;
  BaseMesh base_;
  Vec3 centre_;  // centre of the base mesh, lattice units
  std::optional<Refiner> refiner_;
  std::optional<Planner> planner_;
  std::optional<std::uint32_t> triangles_;  // the detail target, if it is a number of triangles
  double most_triangles_ = 0;  // maximum number of triangles, if the detail target is a view
  std::vector<std::uint8_t> applied_;
  bool needs_restart_ = false;  // whether no chunk can be applied until restart()

  std::vector<double> summary_;
  // Displayed positions of all vertices, in lattice units from the centre.
  Segments<std::array<float, 3>> shown_;
  VertexId vertices_out_ = 0;    // number of vertices returned since display()
  std::uint32_t faces_out_ = 0;  // number of faces of connectivity() visited since display()
  std::vector<std::array<float, 3>> positions_;
  std::vector<std::array<std::int16_t, 4>> normals_;
  VertexAttributes attributes_;
  std::vector<Vec3i> lattice_positions_;
  std::vector<Triangle> faces_;
};

}  // namespace vitrine::inline codec
