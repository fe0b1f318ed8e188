// SPDX-License-Identifier: Apache-2.0
// Small meshes for tests of import and export.
#pragma once

#include "codec/import/read_mesh.h"
#include "codec/repair/repair.h"
#include "support/as_bytes.h"

namespace vitrine::testing {

inline TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
          {}};
}

inline TriangleMesh coloured_tetrahedron() {
  TriangleMesh mesh = tetrahedron();
  mesh.attributes.colours = {{0, 1, 2}, {100, 128, 200}, {255, 254, 253}, {7, 77, 177}};
  return mesh;
}

// Returns a flat grid of n x n squares in the plane z = 0, facing up.
inline TriangleMesh grid(std::uint32_t n) {
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y <= n; ++y) {
    for (std::uint32_t x = 0; x <= n; ++x) {
      mesh.positions.push_back({static_cast<double>(x), static_cast<double>(y), 0});
    }
  }
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.faces.push_back({a, b, d});
      mesh.faces.push_back({a, d, c});
    }
  }
  return mesh;
}

inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const auto& [a, b, c] : other.faces)
    mesh.faces.push_back({a + base, b + base, c + base});
}

}  // namespace vitrine::testing
