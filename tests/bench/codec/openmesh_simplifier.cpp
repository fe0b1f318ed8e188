// SPDX-License-Identifier: Apache-2.0
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <stdexcept>

#include "peer_simplifiers.h"
#include "processor_time.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  // The mesh needs these attributes permanently. The decimater's own attributes, which mark deleted
  // faces, would be removed with the decimater.
  VertexAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

Mesh to_openmesh(const TriangleMesh& source) {
  Mesh mesh;
  for (const Vec3& p : source.positions)
    mesh.add_vertex({p.x, p.y, p.z});
  const auto vertex = [&](std::uint32_t v) { return mesh.vertex_handle(v); };
  for (const Triangle& f : source.faces) {
    if (!mesh.add_face(vertex(f[0]), vertex(f[1]), vertex(f[2])).is_valid())
      throw std::runtime_error("OpenMesh does not take the mesh");
  }
  return mesh;
}

TriangleMesh from_openmesh(const Mesh& mesh) {
  TriangleMesh out;
  for (const auto vertex : mesh.vertices()) {
    const auto& p = mesh.point(vertex);
    out.positions.push_back({p[0], p[1], p[2]});
  }
  for (const auto face : mesh.faces()) {
    auto v = mesh.cfv_iter(face);
    const auto next = [&] { return static_cast<std::uint32_t>((v++)->idx()); };
    out.faces.push_back({next(), next(), next()});
  }
  return out;
}

}  // namespace

Simplified simplify_by_openmesh(const TriangleMesh& source, std::size_t faces) {
  Simplified out;
  Mesh mesh = to_openmesh(source);
  out.seconds = seconds([&] {
    OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
    OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
    decimater.add(quadric);
    decimater.module(quadric).unset_max_err();
    decimater.initialize();
    decimater.decimate_to_faces(0, faces);
  });
  mesh.garbage_collection();
  out.mesh = from_openmesh(mesh);
  return out;
}

}  // namespace vitrine::bench
