// SPDX-License-Identifier: Apache-2.0
// Codes the materials and texture coordinates of a source's faces to the bit (codec/FORMAT.md
// section 8.6). Neighbouring faces mostly agree at their common vertices, so a corner takes far
// less than a bit where it does. Elsewhere, the coordinates are predicted.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/mesh/connectivity.h"
#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

// `mesh` is the closed mesh of `faces` faces, and `texturing` has one material per face. Sets of
// coordinates are empty or have one entry per face.
std::vector<std::uint8_t> encode_source_coordinates(const Connectivity& mesh, std::uint32_t faces,
                                                    Texturing texturing);

// Sets `texturing.face_materials`, and the coordinates of each set that `has_set` names. Fails
// (kBadInput) if a material is out of range of `texturing.materials`, or if a coordinate is not
// finite. Safe on hostile bytes: allocates memory for the faces only.
Expected<void> decode_source_coordinates(std::span<const std::uint8_t> bytes,
                                         const Connectivity& mesh, std::uint32_t faces,
                                         const std::array<bool, kCoordinateSets>& has_set,
                                         Texturing& texturing);

}  // namespace vitrine::inline codec
