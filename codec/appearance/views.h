// SPDX-License-Identifier: Apache-2.0
// The views from which the appearance of models is compared.
#pragma once

#include <array>

#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"
#include "codec/render/framing.h"

namespace vitrine::inline codec {

inline constexpr std::size_t kViews = 12;
inline constexpr std::uint32_t kViewSize = 512;  // width and height of a view in pixels

// Returns the directions from the centre of a regular icosahedron to its twelve vertices. These are
// (0, ±1, ±φ) and their cyclic permutations, where φ is the golden ratio. The directions are evenly
// spread and come in opposite pairs. No direction is vertical.
std::array<Vec3, kViews> view_directions();

// Returns twelve square views of `reference`, in parallel projection. Each view shows the bounding
// sphere with a margin of eight pixels. The sphere's centre is that of the bounding box. Fails
// (kBadInput) if the mesh has no faces or all their corners are at the same point.
Expected<std::array<Framing, kViews>> views_around(const TriangleMesh& reference);

}  // namespace vitrine::inline codec
