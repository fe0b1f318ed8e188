// SPDX-License-Identifier: Apache-2.0
// The writers behind write_mesh(), each in its own file. They require a mesh that write_mesh() has
// checked.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

using FileBytes = std::vector<std::uint8_t>;

// Each writer returns the bytes of a file. Writers with a parameter `unit` state the unit in a
// comment unless it is empty.
FileBytes write_ply(const TriangleMesh& mesh, std::string_view unit);
FileBytes write_obj(const TriangleMesh& mesh, std::string_view unit);
FileBytes write_stl(const TriangleMesh& mesh, std::string_view unit);
FileBytes write_glb(const TriangleMesh& mesh);
FileBytes write_vrml(const TriangleMesh& mesh);

}  // namespace vitrine::inline codec
