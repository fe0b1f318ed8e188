// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/manifold.h"

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>

#include <algorithm>
#include <array>

#include "codec/repair/edge_pairs.h"

namespace vitrine::inline codec {
namespace {

using Kernel = OpenMesh::TriConnectivity;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

constexpr std::uint32_t next(std::uint32_t c) {
  return c % 3 == 2 ? c - 2 : c + 1;
}
constexpr std::uint32_t prev(std::uint32_t c) {
  return c % 3 == 0 ? c + 2 : c - 1;
}

// Marks all corners in the fan of corner c. Walks from c in both directions until it reaches a
// border or c itself.
void visit_fan(std::uint32_t c, std::span<const std::uint32_t> across, std::vector<bool>& seen) {
  for (std::uint32_t at = c; !seen[at];) {
    seen[at] = true;
    if (across[next(at)] == kNoPartner) break;
    at = next(across[next(at)]);
  }
  for (std::uint32_t at = c; across[prev(at)] != kNoPartner;) {
    at = prev(across[prev(at)]);
    if (seen[at]) break;
    seen[at] = true;
  }
}

std::vector<bool> vertices_with_several_fans(std::uint32_t vertex_count,
                                             std::span<const Triangle> faces,
                                             std::span<const std::uint32_t> across, bool& any) {
  std::vector<bool> seen(3 * faces.size(), false);
  std::vector<bool> has_fan(vertex_count, false), several(vertex_count, false);
  for (std::uint32_t c = 0; c < seen.size(); ++c) {
    if (seen[c]) continue;
    const std::uint32_t v = faces[c / 3][c % 3];
    if (has_fan[v]) several[v] = any = true;
    has_fan[v] = true;
    visit_fan(c, across, seen);
  }
  return several;
}

// A half-edge mesh of all faces at vertices that have several fans.
class SharedFans {
 public:
  SharedFans(std::uint32_t vertex_count, std::span<Triangle> faces,
             std::span<const std::uint32_t> across, const std::vector<bool>& several)
      : faces_(faces), across_(across), local_(vertex_count, -1), has_several_fans_(several) {
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
      const auto [a, b, c] = faces[f];
      if (several[a] || several[b] || several[c]) add(f);
    }
    close_borders();
  }

  // The first fan of each vertex keeps the vertex; every other fan gets a new vertex. Returns, for
  // each new vertex, the original vertex.
  std::vector<std::uint32_t> split() {
    std::vector<std::uint32_t> origins;
    const std::size_t named = kernel_.n_vertices();
    std::vector<bool> seen(kernel_.n_halfedges(), false), has_fan(named, false);
    for (const HalfedgeHandle start : kernel_.halfedges()) {
      const VertexHandle v = kernel_.from_vertex_handle(start);
      if (seen[start.idx()]) continue;
      const bool first = !has_fan[v.idx()];
      has_fan[v.idx()] = true;
      const std::uint32_t origin = global_[v.idx()];
      const VertexHandle owner = first || !has_several_fans_[origin] ? v : kernel_.new_vertex();
      if (owner != v) origins.push_back(origin), global_.push_back(next_copy_++);
      kernel_.set_halfedge_handle(owner, start);
      // At the rim of this part of the mesh, a vertex may have several fans in the part but only
      // one fan in the whole mesh. Such a vertex is not split.
      for (const HalfedgeHandle out : kernel_.voh_range(owner)) {
        seen[out.idx()] = true;
        kernel_.set_vertex_handle(kernel_.opposite_halfedge_handle(out), owner);
      }
    }
    return origins;
  }

  // Writes the kernel's vertices back to the faces.
  void store() const {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const HalfedgeHandle into = edge_[3 * i + (k + 1) % 3];
        faces_[members_[i]][k] = global_[kernel_.to_vertex_handle(into).idx()];
      }
    }
  }

 private:
  VertexHandle local(std::uint32_t v) {
    if (local_[v] < 0) {
      local_[v] = kernel_.new_vertex().idx();
      global_.push_back(v);
    }
    return VertexHandle(local_[v]);
  }

  void add(std::uint32_t f) {
    const FaceHandle face = kernel_.new_face();
    std::array<HalfedgeHandle, 3> inner;
    for (std::uint32_t k = 0; k < 3; ++k)
      inner[k] = half_edge(f, k);
    for (std::uint32_t k = 0; k < 3; ++k) {
      kernel_.set_next_halfedge_handle(inner[k], inner[(k + 1) % 3]);
      kernel_.set_face_handle(inner[k], face);
    }
    kernel_.set_halfedge_handle(face, inner[0]);
    edge_.insert(edge_.end(), inner.begin(), inner.end());
    members_.push_back(f);
  }

  // Returns the half-edge opposite to corner k of face f. If the half-edge of the partner corner
  // exists, returns its twin. Otherwise adds a new edge.
  HalfedgeHandle half_edge(std::uint32_t f, std::uint32_t k) {
    const std::uint32_t partner = across_[3 * f + k];
    if (partner != kNoPartner && partner < 3 * f) {
      const auto it = std::lower_bound(members_.begin(), members_.end(), partner / 3);
      if (it != members_.end() && *it == partner / 3) {
        const auto i = static_cast<std::size_t>(it - members_.begin());
        return kernel_.opposite_halfedge_handle(edge_[3 * i + partner % 3]);
      }
    }
    return kernel_.new_edge(local(faces_[f][(k + 1) % 3]), local(faces_[f][(k + 2) % 3]));
  }

  // Links each border half-edge to the next border half-edge of the same fan.
  void close_borders() {
    for (const HalfedgeHandle border : kernel_.halfedges()) {
      if (!kernel_.is_boundary(border)) continue;
      HalfedgeHandle out = kernel_.opposite_halfedge_handle(border);
      while (!kernel_.is_boundary(out)) {
        out = kernel_.opposite_halfedge_handle(kernel_.prev_halfedge_handle(out));
      }
      kernel_.set_next_halfedge_handle(border, out);
    }
  }

  Kernel kernel_;
  std::span<Triangle> faces_;
  std::span<const std::uint32_t> across_;
  std::vector<int> local_;              // vertex of the mesh -> vertex in kernel_, or -1
  std::vector<std::uint32_t> global_;   // vertex in kernel_ -> vertex of the mesh
  std::vector<std::uint32_t> members_;  // faces in kernel_, in ascending order
  std::vector<HalfedgeHandle> edge_;    // per corner of members_: the opposite half-edge
  const std::vector<bool>& has_several_fans_;
  std::uint32_t next_copy_ = static_cast<std::uint32_t>(local_.size());
};

}  // namespace

std::vector<std::uint32_t> split_fans(std::uint32_t vertex_count, std::span<Triangle> faces,
                                      std::span<const std::uint32_t> across) {
  bool any = false;
  const auto several = vertices_with_several_fans(vertex_count, faces, across, any);
  if (!any) return {};
  SharedFans part(vertex_count, faces, across, several);
  auto origins = part.split();
  part.store();
  return origins;
}

}  // namespace vitrine::inline codec
