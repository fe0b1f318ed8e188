// SPDX-License-Identifier: Apache-2.0
#include "codec/export/seam_vertices.h"

#include <bit>

namespace vitrine::inline codec {
namespace {

// The bits of a corner's texture coordinates, in all sets.
using CornerBits = std::array<std::array<std::uint32_t, 2>, kCoordinateSets>;

CornerBits bits_of(const Texturing& texturing, std::size_t face, std::size_t k) {
  CornerBits bits{};
  for (std::size_t set = 0; set < kCoordinateSets; ++set) {
    if (texturing.coordinates[set].empty()) continue;
    bits[set] = std::bit_cast<std::array<std::uint32_t, 2>>(texturing.coordinates[set][face][k]);
  }
  return bits;
}

}  // namespace

SeamVertices split_at_seams(const TriangleMesh& mesh, const Texturing& texturing) {
  constexpr std::uint32_t kNone = 0xFFFF'FFFFu;
  SeamVertices out;
  // The new vertices of one old vertex form a linked list. `newest` holds the first of each list,
  // and `before` links each new vertex to the previous one.
  std::vector<std::uint32_t> newest(mesh.positions.size(), kNone), before;
  std::vector<CornerBits> bits;  // per new vertex: the bits of its coordinates
  const auto vertex_for = [&](std::uint32_t v, const CornerBits& at) {
    for (std::uint32_t known = newest[v]; known != kNone; known = before[known]) {
      if (bits[known] == at) return known;
    }
    const auto fresh = static_cast<std::uint32_t>(out.original.size());
    out.original.push_back(v);
    bits.push_back(at);
    before.push_back(newest[v]);
    return newest[v] = fresh;
  };
  out.faces.reserve(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    Triangle face{};
    for (std::size_t k = 0; k < 3; ++k)
      face[k] = vertex_for(mesh.faces[f][k], bits_of(texturing, f, k));
    out.faces.push_back(face);
  }
  for (std::size_t set = 0; set < kCoordinateSets; ++set) {
    if (texturing.coordinates[set].empty()) continue;
    for (const CornerBits& corner : bits)
      out.coordinates[set].push_back(std::bit_cast<TextureCoordinates>(corner[set]));
  }
  return out;
}

}  // namespace vitrine::inline codec
