// SPDX-License-Identifier: Apache-2.0
// The top of the table with nothing on it.
#pragma once

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::rig {

// A disc about the axis at z = 0, mm.
TriangleMesh plate();

}  // namespace vitrine::rig
