// SPDX-License-Identifier: Apache-2.0
// Renders a mesh on the CPU, in parallel projection.
#pragma once

#include "codec/picture/picture.h"
#include "codec/render/framing.h"
#include "codec/render/shaded_mesh.h"

namespace vitrine::inline codec {

// Renders a model with smooth shading. The background is transparent: opacity 0 and colour black. A
// partly covered pixel has the colour of its covered part. Both sides of faces are visible.
// Positions must be finite and face indices in range.
Picture render(const ShadedMesh& model, const Framing& frame);

// Renders a mesh without textures.
Picture render(const TriangleMesh& mesh, const Framing& frame);

}  // namespace vitrine::inline codec
