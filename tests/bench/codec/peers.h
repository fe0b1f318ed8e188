// SPDX-License-Identifier: Apache-2.0
// Functions that wrap the libraries with which the codec is compared.
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

// Decodes the file in this process. Returns the number of faces.
std::uint32_t draco_decode(std::span<const std::uint8_t> bytes);

// Returns the mesh of a Draco file, without colours.
TriangleMesh draco_mesh(std::span<const std::uint8_t> bytes);

// A mesh as flat arrays in meshoptimizer's layout. It is prepared before the measurement, so the
// measured time excludes the conversion.
struct MeshoptInput {
  std::vector<float> positions;
  std::vector<float> attributes;  // `attribute_count` values per vertex
  std::uint32_t attribute_count = 0;
  std::vector<std::uint32_t> indices;
};
MeshoptInput meshopt_input(const TriangleMesh& mesh);

// Returns the indices that remain after meshopt_simplify has reduced the mesh to about `faces`
// triangles.
std::vector<std::uint32_t> meshopt_simplify_to(const MeshoptInput& mesh, std::size_t faces);

}  // namespace vitrine::bench
