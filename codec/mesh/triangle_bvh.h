// SPDX-License-Identifier: Apache-2.0
// Finds the triangle of a mesh that is closest to a point. The bounding volume hierarchy is one
// flat array.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/mesh/closest_point.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

struct ClosestTriangle {
  double squared = std::numeric_limits<double>::infinity();  // squared distance to the query point
  std::uint32_t triangle = 0xFFFF'FFFFu;  // index of the triangle in the TriangleBvh
};

class TriangleBvh {
 public:
  struct Node {
    std::array<float, 3> low, high;  // corners of the bounding box, rounded outwards
    // In a leaf, the first triangle. In an inner node, the left child, which the right child
    // follows.
    std::uint32_t first;
    std::uint32_t count;  // number of triangles in a leaf; 0 in an inner node
  };
  static constexpr std::uint32_t kLeafSize = 4;

  // Builds the hierarchy. Face indices must be in range and positions finite.
  explicit TriangleBvh(const TriangleMesh& mesh);
  TriangleBvh(TriangleBvh&&) = default;
  TriangleBvh& operator=(TriangleBvh&&) = default;
  // Makes a hierarchy of the same faces with moved vertices. Borrows everything except the
  // positions from `shape`, which must outlive this object and must have been built from a mesh.
  // `moved` holds the new positions in the order of shape.positions(). Queries stay fast if the
  // vertices moved little.
  TriangleBvh(const TriangleBvh& shape, std::vector<Vec3> moved);

  bool empty() const { return faces_.empty(); }
  std::uint32_t size() const { return static_cast<std::uint32_t>(faces_.size()); }
  // The nodes of the tree; the root is nodes()[0]. In an object with moved vertices, these are the
  // nodes of its shape, whose boxes bound the vertices before the move.
  std::span<const Node> nodes() const { return nodes_; }
  // Returns the corners of triangle t. Triangles are numbered in the order of the leaves.
  TrianglePoints triangle(std::uint32_t t) const {
    const Triangle& f = faces_[t];
    return {positions_[f[0]], positions_[f[1]], positions_[f[2]]};
  }
  const Vec3& point(std::uint32_t t, std::uint32_t k) const { return positions_[faces_[t][k]]; }
  // The triangles as vertex indices. Vertices are numbered in order of first use.
  std::span<const Triangle> faces() const { return faces_; }
  std::span<const Vec3> positions() const { return positions_; }
  // For each vertex, its index in the mesh. Empty in an object with moved vertices.
  std::span<const std::uint32_t> vertices() const { return vertices_; }

  // Returns the closest triangle, or `bound` if no triangle is closer than `bound`. A tight bound,
  // such as the distance to a nearby triangle, makes the query several times faster.
  ClosestTriangle closest(const Vec3& p, ClosestTriangle bound = {}) const;

 private:
  void add_faces(const TriangleMesh& mesh);
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);
  void bound_box(Node& node, std::uint32_t first, std::uint32_t count) const;
  void bound_children(Node& node) const;

  std::vector<Node> own_nodes_;
  std::vector<Triangle> own_faces_;
  std::span<const Node> nodes_;      // refers to own_nodes_ or to the shape's nodes
  std::span<const Triangle> faces_;  // refers to own_faces_ or to the shape's faces
  std::vector<Vec3> positions_;
  std::vector<std::uint32_t> vertices_;
  // Largest distance, in model units, by which a moved triangle may extend beyond its box.
  double slack_ = 0;
};

}  // namespace vitrine::inline codec
