// SPDX-License-Identifier: Apache-2.0
// The writers behind write_mesh(), one file each. They trust the mesh that write_mesh() checked.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

using FileBytes = std::vector<std::uint8_t>;

// `unit` goes into a comment where it is not empty.
FileBytes write_ply(const TriangleMesh& mesh, std::string_view unit);
FileBytes write_obj(const TriangleMesh& mesh, std::string_view unit);
FileBytes write_stl(const TriangleMesh& mesh, std::string_view unit);
FileBytes write_glb(const TriangleMesh& mesh);
FileBytes write_vrml(const TriangleMesh& mesh);

}  // namespace vitrine
