// SPDX-License-Identifier: Apache-2.0
// Changes a mesh's texturing to match changes of the mesh's faces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

// Returns the texture coordinates of each face's corners. Vertices beyond the end of `of_vertices`
// have (0, 0).
std::vector<std::array<TextureCoordinates, 3>> coordinates_of_corners(
    std::span<const Triangle> faces, std::span<const TextureCoordinates> of_vertices);

// Removes the sets of texture coordinates that no map uses. Resizes every other set to one entry
// per face.
void fit_coordinate_sets(Texturing& texturing);

// Replaces coordinates that are not finite by 0. Returns the number of corners that had such a
// coordinate.
std::uint64_t make_finite(Texturing& texturing);

// Removes the entries of the marked faces. The other faces keep their order.
void erase_faces(Texturing& texturing, const std::vector<bool>& marked);

// Swaps the entries of the face's second and third corner, after these were swapped in the mesh.
void reverse_face(Texturing& texturing, std::size_t face);

}  // namespace vitrine::inline codec
