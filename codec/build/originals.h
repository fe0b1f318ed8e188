// SPDX-License-Identifier: Apache-2.0
// The originals of a texture: materials, texture coordinates and pictures of the source, to the
// bit. They are optional blocks at the end of a file (codec/FORMAT.md section 8.6), which no viewer
// needs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/format/manifest.h"
#include "codec/mesh/texturing.h"
#include "codec/refine/refiner.h"

namespace vitrine::inline codec {

// Adds the originals to the end of a file. `faces` are the faces at full resolution in the order of
// a refiner to which all chunks were applied in file order, with `vertices` vertices in any
// numbering; `texturing` belongs to them. Leaves the file unchanged if the source has too many
// pictures (kMaxOptionalBlocks); returns whether it was added. `body` is the file behind its
// header.
bool add_originals(std::span<const Triangle> faces, std::uint32_t vertices,
                   const Texturing& texturing, Manifest& manifest, std::vector<std::uint8_t>& body);

// Whether the file has the originals of its texture.
bool has_originals(const Manifest& manifest);

// Returns the size in bytes of the originals.
std::uint64_t originals_bytes(const Manifest& manifest);

// Returns the originals for the faces of refiner.lattice_mesh(). All chunks of the model must have
// been applied in file order. Fails (kState) if the file has no originals or the refiner is not at
// full resolution, and (kBadInput) if `pmesh` ends before them or they are damaged. Safe on hostile
// bytes. The pictures are not decoded.
Expected<Texturing> originals_of(const Refiner& refiner, std::span<const std::uint8_t> pmesh);

// Whether both texturings have the same materials, pictures and names, to the bit. Does not compare
// faces; source_face_set() does.
bool have_same_materials(const Texturing& a, const Texturing& b);

}  // namespace vitrine::inline codec
