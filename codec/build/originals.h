// SPDX-License-Identifier: Apache-2.0
// The originals of a texture: exact copies of the materials, texture coordinates and pictures of
// the source mesh. They are optional blocks at the end of a file (codec/FORMAT.md section 8.6).
// Viewers do not need them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/format/manifest.h"
#include "codec/mesh/texturing.h"
#include "codec/refine/refiner.h"

namespace vitrine::inline codec {

// Adds the originals to the end of a file. `faces` are the faces at full resolution, in the order
// in which a Refiner has them after applying all chunks in file order. They have `vertices`
// vertices, numbered in any order. `texturing` describes these faces. `body` is the file after its
// header. Returns false and leaves the file unchanged if the source has too many pictures
// (kMaxOptionalBlocks).
bool add_originals(std::span<const Triangle> faces, std::uint32_t vertices,
                   const Texturing& texturing, Manifest& manifest, std::vector<std::uint8_t>& body);

// Whether the file contains the originals of its texture.
bool has_originals(const Manifest& manifest);

// Returns the size in bytes of the originals.
std::uint64_t originals_bytes(const Manifest& manifest);

// Returns the originals for the faces of refiner.lattice_mesh(). All chunks of the model must have
// been applied in file order. Fails (kState) if the file has no originals or the refiner is not at
// full resolution, and (kBadInput) if the originals in `pmesh` are damaged or cut off. Safe on
// hostile bytes. The pictures are not decoded.
Expected<Texturing> originals_of(const Refiner& refiner, std::span<const std::uint8_t> pmesh);

// Whether both texturings have identical materials, pictures and picture names. Does not compare
// faces; use source_face_set() for this.
bool have_same_materials(const Texturing& a, const Texturing& b);

}  // namespace vitrine::inline codec
