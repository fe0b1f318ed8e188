// SPDX-License-Identifier: Apache-2.0
// Gives all faces of each patch the same orientation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/repair/edge_groups.h"

namespace vitrine::inline codec {

// Gives all faces of each patch the orientation of the patch's majority. A patch consists of faces
// connected by edges with exactly two faces. Patches whose faces already agree do not change.
// `groups` holds the edges of `faces` and is not updated. Returns the reversed faces in ascending
// order. The second and third corners of these faces were swapped.
std::vector<std::uint32_t> orient_patches(std::span<Triangle> faces, const EdgeGroups& groups);

}  // namespace vitrine::inline codec
