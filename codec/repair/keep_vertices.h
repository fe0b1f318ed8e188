// SPDX-License-Identifier: Apache-2.0
// Removes unused vertices from a mesh.
#pragma once

#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/mesh/vertex_attributes.h"

namespace vitrine::inline codec {

// Removes the vertices that are not marked in `keep`, and renumbers the vertices in `faces`. No
// face may use a removed vertex. Returns the number of removed vertices.
std::size_t keep_vertices(const std::vector<bool>& keep, std::vector<Vec3>& positions,
                          VertexAttributes& attributes, std::span<Triangle> faces);

// Returns, for each of `count` vertices, whether a face uses it.
std::vector<bool> used_vertices(std::size_t count, std::span<const Triangle> faces);

}  // namespace vitrine::inline codec
