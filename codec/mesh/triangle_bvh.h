// SPDX-License-Identifier: Apache-2.0
// Closest-point queries on a triangle mesh: a bounding volume hierarchy in one flat array.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/mesh/closest_point.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

struct SurfacePoint {
  double squared = std::numeric_limits<double>::infinity();  // distance to the query point
  std::uint32_t triangle = 0xFFFF'FFFFu;                     // of the TriangleBvh
};

class TriangleBvh {
 public:
  struct Node {
    std::array<float, 3> low, high;  // rounded outwards
    std::uint32_t first;             // a leaf's first triangle, or the left child (right is next)
    std::uint32_t count;             // of triangles in a leaf; 0 in an inner node
  };
  static constexpr std::uint32_t kLeafSize = 4;

  // Face indices are in range, positions finite.
  explicit TriangleBvh(const TriangleMesh& mesh);
  TriangleBvh(TriangleBvh&&) = default;
  TriangleBvh& operator=(TriangleBvh&&) = default;
  // Over the same faces with their vertices moved: borrows all but the positions from `shape`,
  // which outlives this and was made from a mesh. `moved` follows shape.positions(). Queries stay
  // fast where vertices moved little.
  TriangleBvh(const TriangleBvh& shape, std::vector<Vec3> moved);

  bool empty() const { return faces_.empty(); }
  std::uint32_t size() const { return static_cast<std::uint32_t>(faces_.size()); }
  // [0] is the root. The boxes are those of the shape, where there is one.
  std::span<const Node> nodes() const { return nodes_; }
  // Triangles are counted in leaf order.
  Corners triangle(std::uint32_t t) const {
    const Triangle& f = faces_[t];
    return {positions_[f[0]], positions_[f[1]], positions_[f[2]]};
  }
  const Vec3& point(std::uint32_t t, std::uint32_t k) const { return positions_[faces_[t][k]]; }
  // The triangles as faces over vertices that are numbered as they come by.
  std::span<const Triangle> faces() const { return faces_; }
  std::span<const Vec3> positions() const { return positions_; }
  // What each of these vertices was in the mesh. Empty where there is a shape.
  std::span<const std::uint32_t> vertices() const { return vertices_; }

  // The closest triangle, or `bound` as given where none is closer than it. A good bound, such as
  // the distance to a triangle near by, makes the query several times faster.
  SurfacePoint closest(const Vec3& p, SurfacePoint bound = {}) const;

 private:
  void add_faces(const TriangleMesh& mesh);
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);
  void bound_box(Node& node, std::uint32_t first, std::uint32_t count) const;
  void bound_children(Node& node) const;

  std::vector<Node> own_nodes_;
  std::vector<Triangle> own_faces_;
  std::span<const Node> nodes_;      // own, or the shape's; the faces, too
  std::span<const Triangle> faces_;  // over positions_, so that neighbours lie close in memory
  std::vector<Vec3> positions_;
  std::vector<std::uint32_t> vertices_;
  double slack_ = 0;  // how far a triangle may reach out of its box
};

}  // namespace vitrine
