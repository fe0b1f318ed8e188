// SPDX-License-Identifier: Apache-2.0
// One model in the browser: its manifest, the surface refined so far and the plan towards a want.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/progressive/base_mesh.h"
#include "codec/progressive/manifest.h"
#include "codec/progressive/planner.h"
#include "codec/progressive/refiner.h"

namespace vitrine {

class Model {
 public:
  static Expected<Model> open(std::span<const std::uint8_t> header);

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
  int next_chunk();  // -1: none
  Expected<void> apply(std::size_t chunk, std::span<const std::uint8_t> bytes);
  void trim();
  double bytes_held() const;

  const Refiner& refiner() const { return *refiner_; }

  void display();
  const std::vector<float>& display_positions() const { return positions_; }
  const std::vector<std::int16_t>& display_normals() const { return normals_; }
  const std::vector<std::uint32_t>& display_indices() const { return indices_; }
  const std::vector<Colour>& display_colours() const { return colours_; }

  // [0] levels [1] chunks [2] base offset [3] base length [4] file bytes [5] coloured [6] lattice
  // bits [7] lattice step [8..10] centre; then per level: vertices, faces, max error, rms error,
  // cumulative bytes; then per chunk: level, region, offset, length.
  const std::vector<double>& summary();

 private:
  Expected<void> restart();
  bool exceeds(const Want& goal) const;  // the surface is finer than that somewhere
  void fill_positions(const std::vector<Vec3>& displayed);
  void fill_indices();
  void fill_colours();
  void fill_normals(const std::vector<Vec3>& displayed);

  std::unique_ptr<Manifest> manifest_;  // the planner points to it
  BaseMesh base_;
  Vec3 centre_;  // lattice units
  std::optional<Refiner> refiner_;
  std::optional<Planner> planner_;
  std::optional<std::uint32_t> triangles_;  // of the want, where it is one for triangles
  std::vector<bool> applied_;
  bool trimmed_ = false;  // or failed: nothing can be applied until restart()

  std::vector<double> summary_;
  std::vector<float> positions_;
  std::vector<std::int16_t> normals_;
  std::vector<std::uint32_t> indices_;
  std::vector<Colour> colours_;
};

}  // namespace vitrine
