// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/region_tree.h"

#include <algorithm>
#include <numeric>

namespace vitrine {
namespace {

std::int32_t coordinate(const Vec3i& p, std::uint8_t axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

class Builder {
 public:
  Builder(std::span<const Vec3i> positions, RegionTree& tree)
      : positions_(positions), tree_(tree) {}

  void build(std::span<std::uint32_t> vertices, std::uint32_t regions) {
    if (regions == 1) {
      for (std::uint32_t v : vertices)
        tree_.region[v] = next_region_;
      ++next_region_;
      return;
    }
    const RegionPlane plane = choose(vertices, regions);
    tree_.planes.push_back(plane);
    const auto middle = std::partition(vertices.begin(), vertices.end(), [&](std::uint32_t v) {
      return coordinate(positions_[v], plane.axis) < plane.at;
    });
    const auto first = static_cast<std::size_t>(middle - vertices.begin());
    build(vertices.first(first), regions / 2);
    build(vertices.subspan(first), regions - regions / 2);
  }

 private:
  std::uint8_t longest_axis(std::span<const std::uint32_t> vertices) const {
    Vec3i low = positions_[vertices[0]], high = low;
    for (std::uint32_t v : vertices) {
      const Vec3i& p = positions_[v];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Vec3i side = high - low;
    if (side.x >= side.y && side.x >= side.z) return 0;
    return side.y >= side.z ? 1 : 2;
  }

  RegionPlane choose(std::span<std::uint32_t> vertices, std::uint32_t regions) const {
    if (vertices.empty()) return {};
    const std::uint8_t axis = longest_axis(vertices);
    const std::size_t rank = vertices.size() * (regions / 2) / regions;
    const auto nth = vertices.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(vertices.begin(), nth, vertices.end(), [&](std::uint32_t a, std::uint32_t b) {
      return coordinate(positions_[a], axis) < coordinate(positions_[b], axis);
    });
    return {axis, coordinate(positions_[*nth], axis)};
  }

  std::span<const Vec3i> positions_;
  RegionTree& tree_;
  std::uint16_t next_region_ = 0;
};

}  // namespace

RegionTree build_region_tree(std::span<const Vec3i> positions, std::uint32_t regions) {
  RegionTree tree;
  tree.region.resize(positions.size());
  std::vector<std::uint32_t> vertices(positions.size());
  std::iota(vertices.begin(), vertices.end(), 0u);
  Builder(positions, tree).build(vertices, regions);
  return tree;
}

}  // namespace vitrine
