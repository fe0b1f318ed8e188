// SPDX-License-Identifier: Apache-2.0
// Checks all invariants of Connectivity. Tests call this function after each mutation.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <vector>

#include "codec/mesh/connectivity.h"

namespace vitrine::test {

inline void expect_valid(const Connectivity& mesh) {
  std::set<std::pair<VertexId, VertexId>> edges;
  std::vector<std::uint32_t> loop_faces(mesh.loop_count(), 0);
  std::vector<std::uint32_t> valence(mesh.vertex_count(), 0);
  for (Corner c = 0; c < 3 * mesh.face_count(); ++c) {
    if (mesh.is_dead(c / 3)) continue;
    const VertexId v = mesh.vertex(c);
    ASSERT_TRUE(edges.emplace(v, mesh.vertex(next(c))).second) << "edge twice at corner " << c;
    ASSERT_EQ(mesh.opposite(mesh.opposite(c)), c);
    ASSERT_EQ(mesh.vertex(next(c)), mesh.vertex(prev(mesh.opposite(c))));
    ASSERT_EQ(mesh.vertex(prev(c)), mesh.vertex(next(mesh.opposite(c))));
    is_virtual(v) ? ++loop_faces[v & ~kVirtualBit] : ++valence[v];
  }
  for (VertexId k = 0; k < mesh.loop_count(); ++k) {
    ASSERT_EQ(mesh.loop_length(kVirtualBit + k), loop_faces[k]);
  }
  std::array<Corner, 1024> ring;
  for (VertexId v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.corner_at(v) == kNoCorner) continue;
    ASSERT_EQ(mesh.vertex(mesh.corner_at(v)), v);
    ASSERT_EQ(mesh.ring(v, ring), valence[v]) << "vertex " << v << " has more than one fan";
    ASSERT_GE(valence[v], 3u);
  }
}

inline std::vector<Triangle> live_faces(const Connectivity& mesh) {
  std::vector<Triangle> faces;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.is_dead(f)) continue;
    faces.push_back({mesh.vertex(3 * f), mesh.vertex(3 * f + 1), mesh.vertex(3 * f + 2)});
  }
  return faces;
}

}  // namespace vitrine::test
