// SPDX-License-Identifier: Apache-2.0
// Keeps the texturing of a mesh in step with its faces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

// Returns for each face the coordinates of its corners. Vertices beyond the end of `of_vertices`
// have (0, 0).
std::vector<std::array<TextureCoordinates, 3>> coordinates_of_corners(
    std::span<const Triangle> faces, std::span<const TextureCoordinates> of_vertices);

// Gives every set that a map uses one entry per face, and removes the other sets.
void fit_coordinate_sets(Texturing& texturing);

// Replaces values that are not finite by 0. Returns the number of corners that had one.
std::uint64_t make_finite(Texturing& texturing);

// Removes the marked faces. The other faces keep their order.
void erase_faces(Texturing& texturing, const std::vector<bool>& marked);

// Follows a face whose second and third corner have been exchanged.
void reverse_face(Texturing& texturing, std::size_t face);

}  // namespace vitrine::inline codec
