// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/raw_mesh.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "codec/repair/edge_groups.h"
#include "codec/repair/weld.h"

namespace vitrine::inline codec {
namespace {

// Returns the corners opposite to edges that have only one face.
std::vector<std::uint32_t> border_corners(std::size_t vertex_count,
                                          std::span<const Triangle> faces) {
  std::vector<std::uint32_t> corners;
  const auto visit = [&](std::uint32_t, std::span<const EdgeSide> sides) {
    if (sides.size() == 1) corners.push_back(sides[0].corner);
  };
  EdgeGroups(vertex_count, faces).for_each(visit);
  return corners;
}

class SeamJoiner {
 public:
  SeamJoiner(const std::vector<Vec3>& positions, const VertexAttributes& attributes,
             std::span<const Triangle> faces)
      : positions_(positions), faces_(faces), older_(positions.size()) {
    std::iota(older_.begin(), older_.end(), 0);
    borders_ = border_corners(positions.size(), faces);
    name_points(VertexOrder(positions, attributes));
  }

  // Returns, for each vertex, the vertex with which it is merged. This is a vertex with a lower
  // number, or the vertex itself.
  std::vector<std::uint32_t> join() && {
    std::sort(borders_.begin(), borders_.end(), [&](std::uint32_t a, std::uint32_t b) {
      const EdgeVertices p = points_of(a), q = points_of(b);
      return p != q ? p < q : a < b;
    });
    for (std::size_t i = 0, end; i < borders_.size(); i = end) {
      for (end = i + 1; end < borders_.size() && lie_together(borders_[i], borders_[end]);)
        ++end;
      if (end - i == 2) join_sides(borders_[i], borders_[i + 1]);
    }
    return std::move(older_);
  }

 private:
  using EdgeVertices = std::array<std::uint32_t, 2>;

  void name_points(const VertexOrder& order) {
    std::vector<bool> at_border(positions_.size(), false);
    for (const std::uint32_t corner : borders_) {
      for (const std::uint32_t v : ends_of(corner))
        at_border[v] = true;
    }
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < at_border.size(); ++v) {
      if (at_border[v]) vertices.push_back(v);
    }
    point_.resize(positions_.size());
    order.for_each_oldest(std::move(vertices),
                          [&](std::uint32_t v, std::uint32_t oldest) { point_[v] = oldest; });
  }

  EdgeVertices ends_of(std::uint32_t corner) const {
    const Triangle& face = faces_[corner / 3];
    return {face[(corner + 1) % 3], face[(corner + 2) % 3]};
  }

  EdgeVertices points_of(std::uint32_t corner) const {
    const auto [a, b] = ends_of(corner);
    return {std::min(point_[a], point_[b]), std::max(point_[a], point_[b])};
  }

  bool lie_together(std::uint32_t a, std::uint32_t b) const { return points_of(a) == points_of(b); }

  void join_sides(std::uint32_t a, std::uint32_t b) {
    if (positions_[apex(faces_, a)] == positions_[apex(faces_, b)]) return;
    const EdgeVertices mine = ends_of(a), other = ends_of(b);
    if (point_[mine[0]] == point_[mine[1]]) return;
    const bool same_way = point_[mine[0]] == point_[other[0]];
    join_vertices(mine[0], other[same_way ? 0 : 1]);
    join_vertices(mine[1], other[same_way ? 1 : 0]);
  }

  void join_vertices(std::uint32_t v, std::uint32_t w) {
    v = oldest(v), w = oldest(w);
    older_[std::max(v, w)] = std::min(v, w);
  }

  std::uint32_t oldest(std::uint32_t v) {
    while (older_[v] != v)
      v = older_[v] = older_[older_[v]];
    return v;
  }

  const std::vector<Vec3>& positions_;
  std::span<const Triangle> faces_;
  std::vector<std::uint32_t> borders_;  // corners opposite to the border edges
  // For each end of a border edge: the lowest-numbered vertex with the same position and
  // attributes.
  std::vector<std::uint32_t> point_;
  std::vector<std::uint32_t> older_;
};

}  // namespace

std::vector<std::uint32_t> weld_seams(std::vector<Vec3>& positions, VertexAttributes& attributes,
                                      std::span<const Triangle> faces) {
  std::vector<std::uint32_t> renamed = SeamJoiner(positions, attributes, faces).join();
  merge_into_older(renamed, positions, attributes);
  return renamed;
}

}  // namespace vitrine::inline codec
