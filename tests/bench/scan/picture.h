// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "codec/mesh/triangle_mesh.h"
#include "sections.h"

namespace vitrine::bench {

// Writes NAME.png of a mesh whose z points upwards, where pictures are asked for.
void show(const Options& options, const std::string& name, const TriangleMesh& mesh);

}  // namespace vitrine::bench
