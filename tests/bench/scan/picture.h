// SPDX-License-Identifier: Apache-2.0
// Renders of the meshes that a benchmark compares.
#pragma once

#include <string>

#include "codec/mesh/triangle_mesh.h"
#include "sections.h"
#include "support/product_names.h"

namespace vitrine::bench {

// Writes a picture NAME.png of a mesh whose z axis points upwards. If the options have no folder
// for pictures, writes no file.
void show(const Options& options, const std::string& name, const TriangleMesh& mesh);

}  // namespace vitrine::bench
