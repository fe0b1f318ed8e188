// SPDX-License-Identifier: Apache-2.0
// Codes the materials and texture coordinates of a source mesh's faces without loss
// (codec/FORMAT.md section 8.6). Neighbouring faces mostly have equal coordinates at their common
// vertices. Equal coordinates take far less than one bit. Other coordinates are predicted.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/mesh/connectivity.h"
#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

// `mesh` is a mesh of `faces` faces whose boundary loops are closed. `texturing` has one material
// per face. Each set of coordinates is empty or has one entry per face.
std::vector<std::uint8_t> encode_source_coordinates(const Connectivity& mesh, std::uint32_t faces,
                                                    Texturing texturing);

// Sets `texturing.face_materials` and those sets of coordinates that `has_set` selects. Fails
// (kBadInput) if a material is out of range of `texturing.materials`, or if a coordinate is not
// finite. Safe on hostile bytes: allocates memory for the faces only.
Expected<void> decode_source_coordinates(std::span<const std::uint8_t> bytes,
                                         const Connectivity& mesh, std::uint32_t faces,
                                         const std::array<bool, kCoordinateSets>& has_set,
                                         Texturing& texturing);

}  // namespace vitrine::inline codec
