// SPDX-License-Identifier: Apache-2.0
// Simplifiers of other libraries, each wrapped in one function.
#pragma once

#include <cstddef>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

struct Simplified {
  TriangleMesh mesh;   // without colours; about as many faces as requested
  double seconds = 0;  // processor time of the simplification alone
};

// Simplifies with meshoptimizer's edge collapses. Vertices keep their positions.
Simplified simplify_by_meshopt(const TriangleMesh& mesh, std::size_t faces);

// For each number in `faces`, simplifies with meshoptimizer and moves vertices to better positions,
// which only its npm package supports.
std::vector<Simplified> simplify_by_meshopt_update(const TriangleMesh& mesh,
                                                   const std::vector<std::size_t>& faces);

// Simplifies with OpenMesh's decimater and its quadric error module (ModQuadric).
Simplified simplify_by_openmesh(const TriangleMesh& mesh, std::size_t faces);

// Both functions simplify with CGAL's edge collapses and default policies: the first by [GH97], the
// second by [LT98]. They are defined only if CMake has found CGAL.
Simplified simplify_by_garland_heckbert(const TriangleMesh& mesh, std::size_t faces);
Simplified simplify_by_lindstrom_turk(const TriangleMesh& mesh, std::size_t faces);

}  // namespace vitrine::bench
