// SPDX-License-Identifier: Apache-2.0
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_ratio_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <stdexcept>

#include "peer_simplifiers.h"
#include "processor_time.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

namespace policies = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

Mesh to_cgal(const TriangleMesh& source) {
  Mesh mesh;
  for (const Vec3& p : source.positions)
    mesh.add_vertex({p.x, p.y, p.z});
  const auto vertex = [](std::uint32_t v) { return Mesh::Vertex_index(v); };
  for (const Triangle& f : source.faces) {
    if (mesh.add_face(vertex(f[0]), vertex(f[1]), vertex(f[2])) == Mesh::null_face())
      throw std::runtime_error("CGAL does not take the mesh");
  }
  return mesh;
}

// Converts a CGAL mesh whose vertices and faces are numbered without gaps.
TriangleMesh from_cgal(const Mesh& mesh) {
  TriangleMesh out;
  for (const auto vertex : mesh.vertices()) {
    const auto& p = mesh.point(vertex);
    out.positions.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto face : mesh.faces()) {
    auto v = mesh.vertices_around_face(mesh.halfedge(face)).begin();
    const auto next = [&] { return static_cast<std::uint32_t>(*v++); };
    out.faces.push_back({next(), next(), next()});
  }
  return out;
}

template <class Cost, class Placement>
void collapse(Mesh& mesh, double share, const Cost& cost, const Placement& placement) {
  const policies::Count_ratio_stop_predicate<Mesh> stop(share);
  policies::edge_collapse(mesh, stop, CGAL::parameters::get_cost(cost).get_placement(placement));
}

// Simplifies with `run`, whose arguments are a mesh and the share of its edges to keep. On a closed
// mesh, this share equals the share of faces that remain.
template <class Run>
Simplified simplify(const TriangleMesh& source, std::size_t faces, const Run& run) {
  Simplified out;
  Mesh mesh = to_cgal(source);
  const double share = static_cast<double>(faces) / static_cast<double>(source.faces.size());
  out.seconds = seconds([&] { run(mesh, share); });
  mesh.collect_garbage();
  out.mesh = from_cgal(mesh);
  return out;
}

}  // namespace

Simplified simplify_by_garland_heckbert(const TriangleMesh& source, std::size_t faces) {
  return simplify(source, faces, [](Mesh& mesh, double share) {
    const policies::GarlandHeckbert_plane_policies<Mesh, Kernel> quadrics(mesh);
    collapse(mesh, share, quadrics.get_cost(), quadrics.get_placement());
  });
}

Simplified simplify_by_lindstrom_turk(const TriangleMesh& source, std::size_t faces) {
  return simplify(source, faces, [](Mesh& mesh, double share) {
    collapse(mesh, share, policies::LindstromTurk_cost<Mesh>(),
             policies::LindstromTurk_placement<Mesh>());
  });
}

}  // namespace vitrine::bench
