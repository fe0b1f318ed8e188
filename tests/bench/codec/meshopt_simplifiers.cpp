// SPDX-License-Identifier: Apache-2.0
#include "meshopt_in_node.h"
#include "peer_simplifiers.h"
#include "peers.h"
#include "processor_time.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

std::vector<Triangle> triangles(const std::vector<std::uint32_t>& indices) {
  std::vector<Triangle> faces;
  for (std::size_t i = 0; i < indices.size(); i += 3)
    faces.push_back({indices[i], indices[i + 1], indices[i + 2]});
  return faces;
}

Simplified to_simplified(const SimplifiedArrays& arrays) {
  Simplified out{.seconds = arrays.seconds};
  const std::vector<float>& positions = arrays.mesh.positions;
  for (std::size_t i = 0; i < positions.size(); i += 3)
    out.mesh.positions.push_back({positions[i], positions[i + 1], positions[i + 2]});
  out.mesh.faces = triangles(arrays.mesh.indices);
  return out;
}

}  // namespace

Simplified simplify_by_meshopt(const TriangleMesh& mesh, std::size_t faces) {
  Simplified out;
  const MeshoptInput flat = meshopt_input(mesh);
  std::vector<std::uint32_t> left;
  out.seconds = seconds([&] { left = meshopt_simplify_to(flat, faces); });
  out.mesh.positions = mesh.positions;
  out.mesh.faces = triangles(left);
  return out;
}

std::vector<Simplified> simplify_by_meshopt_update(const TriangleMesh& mesh,
                                                   const std::vector<std::size_t>& faces) {
  std::vector<Simplified> out;
  for (const SimplifiedArrays& arrays : simplify_in_node(meshopt_input(mesh), faces))
    out.push_back(to_simplified(arrays));
  return out;
}

}  // namespace vitrine::bench
