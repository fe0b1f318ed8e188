// SPDX-License-Identifier: Apache-2.0
// A lattice mesh as `.pmesh` bytes without error bounds, and back.
#pragma once

#include <span>
#include <vector>

#include "codec/progressive/refiner.h"
#include "codec/simplify/simplify.h"

namespace vitrine::test {

struct StoredModel {
  Manifest manifest;  // as parse_header reads it
  BaseMesh base;      // as the file's own Draco buffer decodes
  std::vector<std::uint8_t> file;

  std::span<const std::uint8_t> chunk(std::size_t i) const {
    return std::span(file).subspan(manifest.chunks[i].offset, manifest.chunks[i].length);
  }
};

// Simplifies, codes, writes and parses again. Throws std::runtime_error where a step fails.
StoredModel store_model(const LatticeMesh& fine, const SimplifyOptions& options);

Refiner start_refiner(const StoredModel& model);
void apply_chunk(Refiner& refiner, const StoredModel& model, std::size_t chunk);
std::vector<std::size_t> ready_chunks(const Refiner& refiner);

// The surface without its numbering: per face its corners as x y z r g b, from the smallest of the
// three rotations on; sorted.
using SurfaceFace = std::array<std::int32_t, 18>;
std::vector<SurfaceFace> canonical_surface(const LatticeMesh& mesh);

}  // namespace vitrine::test
