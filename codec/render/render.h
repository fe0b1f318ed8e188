// SPDX-License-Identifier: Apache-2.0
// Renders a picture of a mesh on the CPU, with a parallel projection.
#pragma once

#include "codec/picture/picture.h"
#include "codec/render/framing.h"
#include "codec/render/shaded_mesh.h"

namespace vitrine::inline codec {

// Renders a model with smooth shading on a transparent background, which has the opacity 0 and the
// colour black; the colour of a pixel that is partly covered is that of the covered part. Faces are
// visible from both sides. Positions must be finite and face indices in range.
Picture render(const ShadedMesh& model, const Framing& frame);

// Renders a mesh without textures.
Picture render(const TriangleMesh& mesh, const Framing& frame);

}  // namespace vitrine::inline codec
