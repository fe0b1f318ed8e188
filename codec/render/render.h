// SPDX-License-Identifier: Apache-2.0
// Renders a picture of a mesh on the CPU, with a parallel projection from the side. The light and
// the stone colour match the initial view of the viewer page.
#pragma once

#include <cstdint>

#include "codec/mesh/triangle_mesh.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// The part of the model that a picture shows, and the size of the picture.
struct Framing {
  Vec3 centre;                          // the point at the centre of the picture, model units
  double pixel = 1;                     // length of a pixel's side, model units, > 0
  std::uint32_t width = 1, height = 1;  // size in pixels, each >= 1
};

// Returns a framing that shows the whole of `mesh` with a narrow margin. The longer side of the
// picture has `longest` pixels, the other at least half as many.
Framing frame_around(const TriangleMesh& mesh, std::uint32_t longest);

// Renders `mesh` with smooth shading on a transparent background. Faces are visible from both
// sides. Meshes without vertex colours get the stone colour. Positions must be finite and face
// indices in range.
Picture render(const TriangleMesh& mesh, const Framing& frame);

}  // namespace vitrine::inline codec
