// SPDX-License-Identifier: Apache-2.0
#include "codec/mesh/triangle_bvh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vitrine::inline codec {
namespace {

float round_down(double v) {
  const float f = static_cast<float>(v);
  return f > v ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

float round_up(double v) {
  return -round_down(-v);
}

double outside(double v, float low, float high, double slack) {
  const double beyond = std::max(static_cast<double>(low) - v, v - static_cast<double>(high));
  return std::max(beyond - slack, 0.0);
}

double squared_distance(const TriangleBvh::Node& n, const Vec3& p, double slack) {
  const double x = outside(p.x, n.low[0], n.high[0], slack),
               y = outside(p.y, n.low[1], n.high[1], slack),
               z = outside(p.z, n.low[2], n.high[2], slack);
  return x * x + y * y + z * z;
}

// Returns half the surface area of the node's box.
double half_area(const TriangleBvh::Node& n) {
  const double x = n.high[0] - n.low[0], y = n.high[1] - n.low[1], z = n.high[2] - n.low[2];
  return x * y + y * z + z * x;
}

constexpr std::uint32_t kUnnamed = 0xFFFF'FFFFu;

struct Centre {
  std::array<float, 3> at;
  std::uint32_t face;
};

// Returns the axis along which the centres have the largest extent.
std::size_t widest_axis(std::span<const Centre> centres) {
  std::array<float, 3> low = centres[0].at, high = low;
  for (const Centre& c : centres) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], c.at[k]), high[k] = std::max(high[k], c.at[k]);
    }
  }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
  }
  return axis;
}

// Sorts the centres so that a plane separates the two halves of the array. Sorts each half in the
// same way, recursively.
void order(std::span<Centre> centres) {
  if (centres.size() <= TriangleBvh::kLeafSize) return;
  const std::size_t axis = widest_axis(centres), half = centres.size() / 2;
  std::nth_element(centres.begin(), centres.begin() + static_cast<std::ptrdiff_t>(half),
                   centres.end(), [axis](const Centre& a, const Centre& b) {
                     return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.face < b.face;
                   });
  order(centres.first(half));
  order(centres.subspan(half));
}

std::vector<Centre> centres_of(const TriangleMesh& mesh) {
  std::vector<Centre> centres;
  centres.reserve(mesh.faces.size());
  for (const Triangle& f : mesh.faces) {
    const Vec3 sum = mesh.positions[f[0]] + mesh.positions[f[1]] + mesh.positions[f[2]];
    centres.push_back(
        {{static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)},
         static_cast<std::uint32_t>(centres.size())});
  }
  return centres;
}

}  // namespace

TriangleBvh::TriangleBvh(const TriangleMesh& mesh) {
  if (mesh.faces.empty()) return;
  add_faces(mesh);
  own_nodes_.reserve(size());
  own_nodes_.resize(1);
  build(0, 0, size());
  nodes_ = own_nodes_;
  if (!has_overlapping_leaves()) return;
  own_oriented_.resize(own_nodes_.size());
  orient(0, 0, size());
  oriented_ = own_oriented_;
}

void TriangleBvh::add_faces(const TriangleMesh& mesh) {
  std::vector<Centre> centres = centres_of(mesh);
  order(centres);
  own_faces_.reserve(centres.size());
  positions_.reserve(mesh.positions.size());
  vertices_.reserve(mesh.positions.size());
  std::vector<std::uint32_t> renamed(mesh.positions.size(), kUnnamed);
  for (const Centre& c : centres) {
    Triangle& out = own_faces_.emplace_back(mesh.faces[c.face]);
    for (std::uint32_t& v : out) {
      std::uint32_t& name = renamed[v];
      if (name == kUnnamed) {
        name = static_cast<std::uint32_t>(positions_.size());
        positions_.push_back(mesh.positions[v]);
        vertices_.push_back(v);
      }
      v = name;
    }
  }
  faces_ = own_faces_;
}

// Fills `node` for the triangles [first, first + count). Builds the children first, because their
// boxes give the node's box.
void TriangleBvh::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  if (count <= kLeafSize || has_copies_only(first, count)) {
    own_nodes_[node].first = first, own_nodes_[node].count = count;
    bound_box(own_nodes_[node], first, count);
    return;
  }
  const auto left = static_cast<std::uint32_t>(own_nodes_.size());
  own_nodes_.resize(left + 2);
  build(left, first, count / 2);
  build(left + 1, first + count / 2, count - count / 2);
  own_nodes_[node].first = left, own_nodes_[node].count = 0;
  bound_children(own_nodes_[node]);
}

TriangleBvh::TriangleBvh(const TriangleBvh& shape, std::vector<Vec3> moved)
    : nodes_(shape.nodes_),
      oriented_(shape.oriented_),
      faces_(shape.faces_),
      positions_(std::move(moved)) {
  for (std::size_t v = 0; v < positions_.size(); ++v)
    slack_ = std::max(slack_, length(positions_[v] - shape.positions_[v]));
}

void TriangleBvh::bound_children(Node& node) const {
  const Node &left = own_nodes_[node.first], &right = own_nodes_[node.first + 1];
  for (std::size_t k = 0; k < 3; ++k) {
    node.low[k] = std::min(left.low[k], right.low[k]);
    node.high[k] = std::max(left.high[k], right.high[k]);
  }
}

// Whether all triangles [first, first + count) have the same three corners, in any order.
bool TriangleBvh::has_copies_only(std::uint32_t first, std::uint32_t count) const {
  const auto corners = [&](std::uint32_t t) {
    return std::array{point(t, 0), point(t, 1), point(t, 2)};
  };
  const std::array<Vec3, 3> common = corners(first);
  for (std::uint32_t t = first + 1; t < first + count; ++t) {
    if (!std::ranges::is_permutation(corners(t), common)) return false;
  }
  return true;
}

void TriangleBvh::bound_box(Node& node, std::uint32_t first, std::uint32_t count) const {
  Vec3 low = positions_[faces_[first][0]], high = low;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const TrianglePoints t = triangle(i);
    for (const Vec3& p : {t.a, t.b, t.c}) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  node.low = {round_down(low.x), round_down(low.y), round_down(low.z)};
  node.high = {round_up(high.x), round_up(high.y), round_up(high.z)};
}

// Whether the leaves' boxes together have more than kMany times the surface area of the root's box.
// The ratio is the mean number of leaves that a line through the root's box meets. The ratio is
// small for most surfaces. For a fan of long triangles, the ratio grows with the number of
// triangles.
bool TriangleBvh::has_overlapping_leaves() const {
  constexpr double kMany = 64;
  double sum = 0;
  for (const Node& node : nodes_) {
    if (node.count > 0) sum += half_area(node);
  }
  return sum > kMany * half_area(nodes_[0]);
}

// Computes the oriented boxes of `node` and of the nodes below it, for the triangles
// [first, first + count).
void TriangleBvh::orient(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  OrientedBox& box = own_oriented_[node] = OrientedBox(triangle(first + count / 2));
  for (std::uint32_t i = first; i < first + count; ++i) {
    const TrianglePoints t = triangle(i);
    box.add(t.a), box.add(t.b), box.add(t.c);
  }
  if (nodes_[node].count > 0) return;
  orient(nodes_[node].first, first, count / 2);
  orient(nodes_[node].first + 1, first + count / 2, count - count / 2);
}

// Returns a lower bound of the squared distance from p to the node's triangles. Skips the costly
// oriented box if the bound from the box along the coordinate axes is at least `enough`.
double TriangleBvh::squared_to_box(std::uint32_t node, const Vec3& p, double enough) const {
  const double squared = squared_distance(nodes_[node], p, slack_);
  if (oriented_.empty() || squared >= enough) return squared;
  return std::max(squared, oriented_[node].squared_distance(p, slack_));
}

ClosestTriangle TriangleBvh::closest(const Vec3& p, ClosestTriangle best, double precision) const {
  struct PendingNode {
    std::uint32_t node;
    double squared;
  };
  std::array<PendingNode, 64> stack;  // 64 suffice, because the tree is balanced
  std::size_t size = 0;
  best.visited = 0;
  double ignored = std::numeric_limits<double>::infinity();  // least `squared` of all ignored nodes
  if (!empty()) stack[size++] = {0, 0};
  while (size > 0) {
    const PendingNode top = stack[--size];
    const double factor = best.visited < kExactNodes ? 1 : 1 + precision;
    if (top.squared * (factor * factor) >= best.squared) {
      ignored = std::min(ignored, top.squared);
      continue;
    }
    ++best.visited;
    const Node& node = nodes_[top.node];
    const std::uint32_t distinct = node.count > kLeafSize ? 1 : node.count;
    for (std::uint32_t i = node.first; i < node.first + distinct; ++i) {
      const double squared = squared_distance(triangle(i), p);
      if (squared < best.squared) best.squared = squared, best.triangle = i;
    }
    if (node.count > 0) continue;
    std::array<PendingNode, 2> child;
    for (std::uint32_t k = 0; k < 2; ++k)
      child[k] = {node.first + k, squared_to_box(node.first + k, p, best.squared)};
    auto& [near, far] = child;
    if (far.squared < near.squared) std::swap(near, far);
    if (far.squared < best.squared) stack[size++] = far;
    if (near.squared < best.squared) stack[size++] = near;
  }
  best.at_least = std::min(best.squared, ignored);
  return best;
}

}  // namespace vitrine::inline codec
