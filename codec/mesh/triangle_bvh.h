// SPDX-License-Identifier: Apache-2.0
// Finds the triangle of a mesh that is closest to a point. Uses a bounding volume hierarchy in a
// flat array.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/mesh/closest_point.h"
#include "codec/mesh/oriented_box.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

struct ClosestTriangle {
  double squared = std::numeric_limits<double>::infinity();  // squared distance to the point
  std::uint32_t triangle = 0xFFFF'FFFFu;  // index of the triangle in the TriangleBvh
  // No triangle is closer than this squared distance. Equals `squared` if the query is exact.
  double at_least = 0;
  // Number of nodes that the search visited: about a hundred, but a large share of all nodes if
  // many triangles are equally close to the point.
  std::uint32_t visited = 0;
};

class TriangleBvh {
 public:
  struct Node {
    std::array<float, 3> low, high;  // corners of the bounding box, rounded outwards
    // Leaf: index of the first triangle. Inner node: index of the left child; the right child is
    // next.
    std::uint32_t first;
    std::uint32_t count;  // number of triangles in a leaf; 0 in an inner node
  };
  // A leaf with more than kLeafSize triangles holds copies of one triangle. Queries look at the
  // first copy only.
  static constexpr std::uint32_t kLeafSize = 4;

  // Builds the hierarchy. Face indices must be in range, and positions must be finite.
  explicit TriangleBvh(const TriangleMesh& mesh);
  TriangleBvh(TriangleBvh&&) = default;
  TriangleBvh& operator=(TriangleBvh&&) = default;
  // Creates a hierarchy of the same faces with moved vertices. `moved` holds the new positions in
  // the order of shape.positions(). All other data stays in `shape`, which must outlive this object
  // and must have been built from a mesh. Vertices at the same position must move to the same
  // position. Queries stay fast if the vertices moved only slightly.
  TriangleBvh(const TriangleBvh& shape, std::vector<Vec3> moved);

  bool empty() const { return faces_.empty(); }
  std::uint32_t size() const { return static_cast<std::uint32_t>(faces_.size()); }
  // The nodes of the tree; nodes()[0] is the root. If vertices were moved, these are the nodes of
  // `shape`, and their boxes bound the vertices before the move.
  std::span<const Node> nodes() const { return nodes_; }
  // Returns the corners of triangle t. Triangles are numbered in the order of the leaves.
  TrianglePoints triangle(std::uint32_t t) const {
    const Triangle& f = faces_[t];
    return {positions_[f[0]], positions_[f[1]], positions_[f[2]]};
  }
  const Vec3& point(std::uint32_t t, std::uint32_t k) const { return positions_[faces_[t][k]]; }
  // The triangles as vertex indices. Vertices are numbered in the order of their first use.
  std::span<const Triangle> faces() const { return faces_; }
  std::span<const Vec3> positions() const { return positions_; }
  // For each vertex, its index in the mesh. Empty if vertices were moved.
  std::span<const std::uint32_t> vertices() const { return vertices_; }

  // Whether the boxes of many triangles overlap, as in a fan of long triangles. Each node then also
  // has an oriented box. Without oriented boxes, most queries would visit a large share of all
  // nodes.
  bool is_slender() const { return !oriented_.empty(); }

  // Returns the closest triangle, or `bound` if no triangle is closer. A good bound, such as the
  // distance to a nearby triangle, makes the query several times faster. If many triangles are
  // about equally close, an exact query visits most nodes. After kExactNodes nodes, a query
  // therefore ignores triangles that are closer than the best one by less than the factor 1 +
  // `precision`.
  static constexpr std::uint32_t kExactNodes = 256;
  ClosestTriangle closest(const Vec3& p, ClosestTriangle bound = {}, double precision = 0) const;

 private:
  void add_faces(const TriangleMesh& mesh);
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);
  bool has_copies_only(std::uint32_t first, std::uint32_t count) const;
  void bound_box(Node& node, std::uint32_t first, std::uint32_t count) const;
  void bound_children(Node& node) const;
  bool has_overlapping_leaves() const;
  void orient(std::uint32_t node, std::uint32_t first, std::uint32_t count);
  double squared_to_box(std::uint32_t node, const Vec3& p, double enough) const;

  std::vector<Node> own_nodes_;
  std::vector<Triangle> own_faces_;
  std::vector<OrientedBox> own_oriented_;
  std::span<const Node> nodes_;  // view of own_nodes_ or of the shape's nodes
  // view of own_oriented_ or of the shape's boxes: one per node, or empty
  std::span<const OrientedBox> oriented_;
  std::span<const Triangle> faces_;  // view of own_faces_ or of the shape's faces
  std::vector<Vec3> positions_;
  std::vector<std::uint32_t> vertices_;
  // Largest distance, in model units, by which moved triangles may extend beyond their boxes.
  double slack_ = 0;
};

}  // namespace vitrine::inline codec
