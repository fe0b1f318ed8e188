// SPDX-License-Identifier: Apache-2.0
// The top of the empty turntable, as a mesh.
#pragma once

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::acquisition::rig {

// Returns a disc about the axis at z = 0, in mm.
TriangleMesh plate();

}  // namespace vitrine::acquisition::rig
