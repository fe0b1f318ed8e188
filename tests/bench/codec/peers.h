// SPDX-License-Identifier: Apache-2.0
// Wraps each library that the codec is compared with in one function.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

using Bytes = std::vector<std::uint8_t>;

// Returns the file that `draco_encoder -qp BITS -cl 10` writes for the mesh, with its colours if
// any.
Bytes draco_encode(const TriangleMesh& mesh, int bits);

// Decodes in this process and returns the number of faces.
std::uint32_t draco_decode(std::span<const std::uint8_t> bytes);

// Returns the mesh of a Draco file, without colours.
TriangleMesh draco_mesh(std::span<const std::uint8_t> bytes);

// Flat arrays in meshoptimizer's layout, so that its measured time includes only the
// simplification.
struct MeshoptInput {
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
};
MeshoptInput meshopt_input(const TriangleMesh& mesh);

// Returns the indices that remain after one meshopt_simplify to about `faces` triangles.
std::vector<std::uint32_t> meshopt_simplify_to(const MeshoptInput& mesh, std::size_t faces);

}  // namespace vitrine::bench
