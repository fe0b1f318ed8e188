// SPDX-License-Identifier: Apache-2.0
// The libraries that the codec is measured against, each behind one function.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

using Bytes = std::vector<std::uint8_t>;

// What `draco_encoder -qp BITS -cl 10` writes for the mesh; colours travel where the mesh has any.
Bytes draco_encode(const TriangleMesh& mesh, int bits);

// Decodes in process; the number of faces.
std::uint32_t draco_decode(std::span<const std::uint8_t> bytes);

// The mesh that a Draco file holds, without colours.
TriangleMesh draco_mesh(std::span<const std::uint8_t> bytes);

// Flat arrays as meshoptimizer takes them, so that its time holds the simplification alone.
struct MeshoptInput {
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
};
MeshoptInput meshopt_input(const TriangleMesh& mesh);

// The indices that one meshopt_simplify to about `faces` triangles leaves.
std::vector<std::uint32_t> meshopt_simplify_to(const MeshoptInput& mesh, std::size_t faces);

}  // namespace vitrine::bench
