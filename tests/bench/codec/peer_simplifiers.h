// SPDX-License-Identifier: Apache-2.0
// Simplifiers of other libraries, each behind one function.
#pragma once

#include <cstddef>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

struct Simplified {
  TriangleMesh mesh;   // without colours; about as many faces as were asked for
  double seconds = 0;  // of processor time, of the simplification alone
};

// meshoptimizer's edge collapses onto vertices that there are.
Simplified simplify_by_meshopt(const TriangleMesh& mesh, std::size_t faces);

// meshoptimizer with updated positions, which only the npm package can: one mesh per number of
// faces.
std::vector<Simplified> simplify_by_meshopt_update(const TriangleMesh& mesh,
                                                   const std::vector<std::size_t>& faces);

// OpenMesh's decimater with ModQuadric alone.
Simplified simplify_by_openmesh(const TriangleMesh& mesh, std::size_t faces);

// CGAL's edge collapses, the policies as they are without options. Only where CMake found CGAL.
Simplified simplify_by_garland_heckbert(const TriangleMesh& mesh, std::size_t faces);
Simplified simplify_by_lindstrom_turk(const TriangleMesh& mesh, std::size_t faces);

}  // namespace vitrine::bench
