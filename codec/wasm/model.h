// SPDX-License-Identifier: Apache-2.0
// One model in the browser: its manifest, the surface refined so far and the plan towards a want.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/segments.h"
#include "codec/progressive/base_mesh.h"
#include "codec/progressive/manifest.h"
#include "codec/progressive/planner.h"
#include "codec/progressive/refiner.h"

namespace vitrine {

class Model {
 public:
  static Expected<std::unique_ptr<Model>> open(std::span<const std::uint8_t> header);
  explicit Model(std::shared_ptr<const Manifest> manifest);
  Model(const Model&) = delete;  // the planner points into it
  Model& operator=(const Model&) = delete;

  const Manifest& manifest() const { return *manifest_; }

  // kBadInput unless the SHA-256 is the manifest's.
  Expected<void> check_base(std::span<const std::uint8_t> bytes) const;
  Expected<void> check_chunk(std::size_t chunk, std::span<const std::uint8_t> bytes) const;

  // The base mesh is kept: a coarser state is reached by starting over from it.
  Expected<void> start(BaseMesh base);

  // After start(). Says whether the surface went back to the base mesh: it does where it holds
  // something that the want leaves out.
  Expected<bool> want(std::uint32_t kind, double value);
  Expected<bool> want(const Want& goal);
  Expected<bool> want(const View& view, double most_triangles);
  int next_chunk();  // -1: none
  Expected<void> apply(std::size_t chunk, std::span<const std::uint8_t> bytes);
  void trim();
  double bytes_held() const;

  const Refiner& refiner() const { return *refiner_; }

  // The surface is handed out in pieces, so that there is no second copy of it: after display(),
  // each call fills the arrays with the next vertices or faces and says how many; 0 at the end.
  static constexpr std::uint32_t kPiece = 4096;  // at most
  void display();
  std::uint32_t next_vertices();
  std::uint32_t next_faces();
  const std::vector<std::array<float, 3>>& positions() const { return positions_; }
  const std::vector<std::array<std::int16_t, 4>>& normals() const { return normals_; }
  const std::vector<Colour>& colours() const { return colours_; }
  const std::vector<Vec3i>& lattice_positions() const { return lattice_positions_; }
  const std::vector<Triangle>& faces() const { return faces_; }

  // [0] levels [1] chunks [2] base offset [3] base length [4] file bytes [5] coloured [6] lattice
  // bits [7] lattice step [8..10] centre; then per level: vertices, faces, max error, rms error,
  // cumulative bytes; then per chunk: level, region, offset, length.
  const std::vector<double>& summary();

 private:
  Expected<void> restart();
  Expected<bool> pursue(const Want& goal, bool back);
  bool exceeds(const Want& goal) const;  // the surface is finer than that somewhere
  Vec3 shown(VertexId v) const;
  Vec3 normal(VertexId v) const;
  void add_vertex(VertexId v);

  std::shared_ptr<const Manifest> manifest_;
  BaseMesh base_;
  Vec3 centre_;  // lattice units
  std::optional<Refiner> refiner_;
  std::optional<Planner> planner_;
  std::optional<std::uint32_t> triangles_;  // of the want, where it is one for triangles
  double most_triangles_ = 0;               // of the want, where it is a view
  std::vector<std::uint8_t> applied_;
  bool trimmed_ = false;  // or failed: nothing can be applied until restart()

  std::vector<double> summary_;
  Segments<std::array<float, 3>> shown_;  // lattice units from the centre, of all vertices
  VertexId vertices_out_ = 0;             // of the surface being handed out
  std::uint32_t faces_out_ = 0;           // and of the faces that connectivity() has
  std::vector<std::array<float, 3>> positions_;
  std::vector<std::array<std::int16_t, 4>> normals_;
  std::vector<Colour> colours_;
  std::vector<Vec3i> lattice_positions_;
  std::vector<Triangle> faces_;
};

}  // namespace vitrine
