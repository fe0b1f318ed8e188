// SPDX-License-Identifier: Apache-2.0
// Finds the corners of a flat polygon that lie in a triangle. Uses a k-d tree in a flat array.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace vitrine::inline codec {

// A corner of a polygon, projected to a plane. The coordinates are finite.
struct FlatCorner {
  double u = 0, v = 0;
  std::uint32_t vertex = 0;  // corners of the same vertex have the same number
};

// Returns twice the signed area of the triangle abc. Positive if it is counter-clockwise.
inline double signed_area(const FlatCorner& a, const FlatCorner& b, const FlatCorner& c) {
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

class CornerTree {
 public:
  // Builds the tree of the corners whose indices are in `members`. `polygon` must outlive this
  // object.
  CornerTree(std::span<const FlatCorner> polygon, std::vector<std::uint32_t> members);

  bool has(std::uint32_t corner) const { return rank_[corner] != kNoRank; }
  // Removes a corner of the tree.
  void remove(std::uint32_t corner);

  // Whether a corner of the tree lies in the counter-clockwise triangle abc or on its border.
  // Ignores corners of the same vertex as a, b or c.
  bool has_corner_in(const FlatCorner& a, const FlatCorner& b, const FlatCorner& c);

  // Returns the number of nodes that all calls of has_corner_in() have visited.
  std::uint64_t visited() const { return visited_; }

 private:
  static constexpr std::uint32_t kLeafSize = 8, kNoRank = 0xFFFF'FFFFu;

  // Node i has the children 2 i + 1 and 2 i + 2, unless its range has at most kLeafSize corners.
  struct Node {
    double low_u = 0, low_v = 0, high_u = 0, high_v = 0;
    std::uint32_t left = 0;  // number of corners that have not been removed
  };
  struct Range {
    std::uint32_t node, first, count;
    bool is_leaf() const { return count <= kLeafSize; }
    Range lower() const { return {2 * node + 1, first, count / 2}; }
    Range upper() const { return {2 * node + 2, first + count / 2, count - count / 2}; }
  };
  struct Query {
    const FlatCorner &a, &b, &c;
    bool holds(const FlatCorner& p) const;
    bool may_overlap(const Node& node) const;
  };

  void build(Range range);
  void bound(Range range);
  bool search(const Query& query, Range range);

  std::span<const FlatCorner> polygon_;
  std::vector<std::uint32_t> members_;  // in the order of the leaves
  std::vector<std::uint32_t> rank_;     // per corner: index in members_, or kNoRank
  std::vector<Node> nodes_;
  std::uint64_t visited_ = 0;
};

}  // namespace vitrine::inline codec
