// SPDX-License-Identifier: Apache-2.0
// Encodes a lattice mesh as a `.pmesh` file, without computing error bounds. Also decodes such
// files by refinement.
#pragma once

#include <span>
#include <vector>

#include "codec/refine/refiner.h"
#include "codec/simplify/simplify.h"

namespace vitrine::test {

struct StoredModel {
  Manifest manifest;  // the manifest as parse_header() reads it
  BaseMesh base;      // the base mesh as decoded from the file's Draco buffer
  std::vector<std::uint8_t> file;

  std::span<const std::uint8_t> chunk(std::size_t i) const {
    return std::span(file).subspan(manifest.chunks[i].offset, manifest.chunks[i].length);
  }
};

// Simplifies, codes, writes and parses the mesh. Throws std::runtime_error if a step fails.
StoredModel store_model(const LatticeMesh& fine, const SimplifyOptions& options);

// Returns the model with a texture: `atlas` belongs to model.base. It has no pictures.
StoredModel with_atlas(StoredModel model, const BaseAtlas& atlas);

Refiner start_refiner(const StoredModel& model);
void apply_chunk(Refiner& refiner, const StoredModel& model, std::size_t chunk);
std::vector<std::size_t> ready_chunks(const Refiner& refiner);

// canonical_surface() returns the surface in a form that does not depend on the numbering of
// vertices and faces. Each face has its corners as x y z r g b, starting with the smallest corner.
// The faces are sorted.
using SurfaceFace = std::array<std::int32_t, 18>;
std::vector<SurfaceFace> canonical_surface(const LatticeMesh& mesh);

}  // namespace vitrine::test
