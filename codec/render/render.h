// SPDX-License-Identifier: Apache-2.0
// A picture of a mesh without a graphics card: in parallel projection, from the side, in the light
// and of the stone that the viewer page begins with.
#pragma once

#include <cstdint>

#include "codec/mesh/triangle_mesh.h"
#include "codec/render/picture.h"

namespace vitrine {

// The part of the model that a picture shows.
struct Framing {
  Vec3 centre;                          // in the middle of the picture, model units
  double pixel = 1;                     // side of a pixel, model units, > 0
  std::uint32_t width = 1, height = 1;  // pixels, >= 1
};

// The frame around the whole of `mesh`, with a narrow margin: the longer side has `longest` pixels,
// the other one at least half of that.
Framing frame_around(const TriangleMesh& mesh, std::uint32_t longest);

// Smoothly shaded, seen from both sides, transparent around the model. Vertex colours are the
// stone's colours where there are any. Positions are finite, face indices in range.
Picture render(const TriangleMesh& mesh, const Framing& frame);

}  // namespace vitrine
