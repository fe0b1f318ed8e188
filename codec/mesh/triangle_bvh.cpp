// SPDX-License-Identifier: Apache-2.0
#include "codec/mesh/triangle_bvh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vitrine {
namespace {

float round_down(double v) {
  const float f = static_cast<float>(v);
  return f > v ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

float round_up(double v) {
  return -round_down(-v);
}

double outside(double v, float low, float high) {
  return std::max({static_cast<double>(low) - v, 0.0, v - static_cast<double>(high)});
}

double squared_distance(const TriangleBvh::Node& n, const Vec3& p) {
  const double x = outside(p.x, n.low[0], n.high[0]), y = outside(p.y, n.low[1], n.high[1]),
               z = outside(p.z, n.low[2], n.high[2]);
  return x * x + y * y + z * z;
}

constexpr std::uint32_t kUnnamed = 0xFFFF'FFFFu;

struct Centre {
  std::array<float, 3> at;
  std::uint32_t face;
};

// The axis along which the centres spread most.
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

// Orders centres so that halving a range recursively halves it in space.
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
  std::vector<Centre> centres = centres_of(mesh);
  order(centres);
  faces_.reserve(centres.size());
  face_.reserve(centres.size());
  std::vector<std::uint32_t> renamed(mesh.positions.size(), kUnnamed);
  for (const Centre& c : centres) {
    add_face(mesh.faces[c.face], mesh, renamed);
    face_.push_back(c.face);
  }
  nodes_.reserve(centres.size());
  nodes_.resize(1);
  build(0, 0, static_cast<std::uint32_t>(centres.size()));
}

void TriangleBvh::add_face(const Triangle& face, const TriangleMesh& mesh,
                           std::span<std::uint32_t> renamed) {
  Triangle& out = faces_.emplace_back();
  for (std::size_t k = 0; k < 3; ++k) {
    std::uint32_t& name = renamed[face[k]];
    if (name == kUnnamed) {
      name = static_cast<std::uint32_t>(positions_.size());
      positions_.push_back(mesh.positions[face[k]]);
    }
    out[k] = name;
  }
}

// Fills `node` for the triangles [first, first + count), children first: boxes come from below.
void TriangleBvh::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  if (count <= kLeafSize) {
    nodes_[node].first = first, nodes_[node].count = count;
    bound_box(nodes_[node], first, count);
    return;
  }
  const auto left = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(left + 2);
  build(left, first, count / 2);
  build(left + 1, first + count / 2, count - count / 2);
  nodes_[node].first = left, nodes_[node].count = 0;
  bound_children(nodes_[node]);
}

TriangleBvh::TriangleBvh(const TriangleBvh& shape, const TriangleMesh& moved)
    : nodes_(shape.nodes_),
      faces_(shape.faces_),
      positions_(shape.positions_.size()),
      face_(shape.face_) {
  for (std::uint32_t t = 0; t < size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      positions_[faces_[t][k]] = moved.positions[moved.faces[face_[t]][k]];
  }
  for (std::size_t i = nodes_.size(); i-- > 0;) {  // children stand behind their parent
    Node& n = nodes_[i];
    n.count > 0 ? bound_box(n, n.first, n.count) : bound_children(n);
  }
}

void TriangleBvh::bound_children(Node& node) const {
  const Node &left = nodes_[node.first], &right = nodes_[node.first + 1];
  for (std::size_t k = 0; k < 3; ++k) {
    node.low[k] = std::min(left.low[k], right.low[k]);
    node.high[k] = std::max(left.high[k], right.high[k]);
  }
}

void TriangleBvh::bound_box(Node& node, std::uint32_t first, std::uint32_t count) const {
  Vec3 low = positions_[faces_[first][0]], high = low;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Corners t = triangle(i);
    for (const Vec3& p : {t.a, t.b, t.c}) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  node.low = {round_down(low.x), round_down(low.y), round_down(low.z)};
  node.high = {round_up(high.x), round_up(high.y), round_up(high.z)};
}

SurfacePoint TriangleBvh::closest(const Vec3& p, SurfacePoint best) const {
  struct Entry {
    std::uint32_t node;
    double squared;
  };
  std::array<Entry, 64> stack;  // one entry per level of a balanced tree
  std::size_t size = 0;
  if (!empty()) stack[size++] = {0, squared_distance(nodes_[0], p)};
  while (size > 0) {
    const Entry top = stack[--size];
    if (top.squared >= best.squared) continue;
    const Node& node = nodes_[top.node];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const double squared = squared_distance(triangle(i), p);
      if (squared < best.squared) best = {squared, i};
    }
    if (node.count > 0) continue;
    Entry near{node.first, squared_distance(nodes_[node.first], p)};
    Entry far{node.first + 1, squared_distance(nodes_[node.first + 1], p)};
    if (far.squared < near.squared) std::swap(near, far);
    if (far.squared < best.squared) stack[size++] = far;
    if (near.squared < best.squared) stack[size++] = near;
  }
  return best;
}

}  // namespace vitrine
