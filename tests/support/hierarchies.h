// SPDX-License-Identifier: Apache-2.0
// Makes lattice meshes and hierarchies of levels from meshes, and counts their parts.
#pragma once

#include <gtest/gtest.h>

#include "codec/simplify/simplify.h"

namespace vitrine::test {

inline LatticeMesh on_lattice(const TriangleMesh& mesh) {
  return quantise(mesh, fit_lattice(mesh.positions, 12));
}

inline TriangleMesh base_of(const TriangleMesh& mesh, std::uint32_t vertices) {
  const auto hierarchy = simplify(on_lattice(mesh), {.target_vertices = vertices});
  EXPECT_TRUE(hierarchy.has_value());
  return to_model(hierarchy->base);
}

// Returns the number of vertices in components that levels insert.
inline std::size_t inserted_vertices(const Hierarchy& hierarchy) {
  std::size_t vertices = 0;
  for (const auto& level : hierarchy.insertions) {
    for (const Component& component : level)
      vertices += component.ids.size();
  }
  return vertices;
}

}  // namespace vitrine::test
