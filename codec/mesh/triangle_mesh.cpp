// SPDX-License-Identifier: Apache-2.0
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

LatticeMesh quantise(const TriangleMesh& mesh, const Lattice& lattice) {
  LatticeMesh out{
      .lattice = lattice, .positions = {}, .faces = mesh.faces, .attributes = mesh.attributes};
  out.positions.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions)
    out.positions.push_back(lattice.to_lattice(p));
  return out;
}

TriangleMesh to_model(const LatticeMesh& mesh) {
  TriangleMesh out{.positions = {}, .faces = mesh.faces, .attributes = mesh.attributes};
  out.positions.reserve(mesh.positions.size());
  for (const Vec3i& p : mesh.positions)
    out.positions.push_back(mesh.lattice.to_model(p));
  return out;
}

}  // namespace vitrine::inline codec
