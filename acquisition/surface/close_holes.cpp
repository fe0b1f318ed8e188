// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/steps.h"

#include <algorithm>
#include <span>
#include <vector>

#include "codec/mesh/face_neighbours.h"

namespace vitrine::acquisition {
namespace {

struct BoundaryEdge {
  std::uint32_t from, to;
  std::uint32_t face;
};

std::vector<BoundaryEdge> boundary_of(const TriangleMesh& mesh) {
  const auto across = face_neighbours(mesh.faces, mesh.positions.size());
  std::vector<BoundaryEdge> edges;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (across[f][k] == 3 * f + k)
        edges.push_back({mesh.faces[f][k], mesh.faces[f][(k + 1) % 3], f});
    }
  }
  std::ranges::stable_sort(edges, {}, &BoundaryEdge::from);
  return edges;
}

Vec3 normal_of(const TriangleMesh& mesh, std::uint32_t face) {
  const Triangle& f = mesh.faces[face];
  const Vec3& a = mesh.positions[f[0]];
  return cross(mesh.positions[f[1]] - a, mesh.positions[f[2]] - a);
}

class Loop {
 public:
  Loop(const TriangleMesh& mesh, std::vector<BoundaryEdge> edges)
      : mesh_(mesh), edges_(std::move(edges)) {
    for (const BoundaryEdge& e : edges_)
      middle_ += mesh_.positions[e.from];
    middle_ = middle_ * (1 / static_cast<double>(edges_.size()));
  }

  const Vec3& middle() const { return middle_; }
  const std::vector<BoundaryEdge>& edges() const { return edges_; }

  double extent() const {
    Vec3 low = middle_, high = middle_;
    for (const BoundaryEdge& e : edges_) {
      const Vec3& p = mesh_.positions[e.from];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Vec3 size = high - low;
    return std::max({size.x, size.y, size.z});
  }

  // Returns whether the loop is the rim of a hole. Faces are counter-clockwise. The outer rim of a
  // piece of surface is therefore counter-clockwise as well, and the rim of a hole is clockwise.
  bool is_hole() const {
    Vec3 area, normal;
    for (const BoundaryEdge& e : edges_) {
      area += cross(mesh_.positions[e.from] - middle_, mesh_.positions[e.to] - middle_);
      const Vec3 n = normal_of(mesh_, e.face);
      const double size = length(n);
      if (size > 0) normal += n * (1 / size);
    }
    return dot(area, normal) < 0;
  }

 private:
  const TriangleMesh& mesh_;
  std::vector<BoundaryEdge> edges_;
  Vec3 middle_;
};

// Returns the boundary loops. Leaves out each loop that passes through a vertex at which several
// loops meet, because the edge that follows such a vertex is ambiguous.
std::vector<Loop> loops_of(const TriangleMesh& mesh) {
  const std::vector<BoundaryEdge> edges = boundary_of(mesh);
  const auto leaving = [&](std::uint32_t v) {
    const auto first = std::ranges::lower_bound(edges, v, {}, &BoundaryEdge::from);
    const auto last = std::ranges::upper_bound(edges, v, {}, &BoundaryEdge::from);
    return std::span(first, last);
  };
  std::vector<bool> used(edges.size(), false);
  std::vector<Loop> loops;
  for (std::size_t start = 0; start < edges.size(); ++start) {
    std::vector<BoundaryEdge> loop;
    std::size_t at = start;
    while (!used[at]) {
      used[at] = true;
      loop.push_back(edges[at]);
      const auto on = leaving(edges[at].to);
      if (on.size() != 1) break;
      at = static_cast<std::size_t>(on.data() - edges.data());
    }
    if (loop.size() > 2 && loop.back().to == loop.front().from &&
        leaving(loop.front().from).size() == 1)
      loops.emplace_back(mesh, std::move(loop));
  }
  return loops;
}

}  // namespace

std::uint64_t close_holes(TriangleMesh& mesh, double largest) {
  std::vector<Vec3> middles;
  std::vector<Triangle> faces;
  for (const Loop& loop : loops_of(mesh)) {
    if (loop.extent() > largest || !loop.is_hole()) continue;
    const auto middle = static_cast<std::uint32_t>(mesh.positions.size() + middles.size());
    middles.push_back(loop.middle());
    for (const BoundaryEdge& e : loop.edges())
      faces.push_back({e.to, e.from, middle});
  }
  mesh.positions.insert(mesh.positions.end(), middles.begin(), middles.end());
  mesh.faces.insert(mesh.faces.end(), faces.begin(), faces.end());
  return middles.size();
}

}  // namespace vitrine::acquisition
