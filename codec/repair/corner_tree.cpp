// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/corner_tree.h"

#include <algorithm>
#include <utility>

namespace vitrine::inline codec {
namespace {

// Whether a point of the box may lie left of the line from a to b, or on it. Tests the corner of
// the box that is farthest to the left. Rounding is monotonic, so if any point of the box has a
// computed signed area of at least 0, so does that corner.
bool reaches_left(const FlatCorner& a, const FlatCorner& b, const FlatCorner& low,
                  const FlatCorner& high) {
  const FlatCorner farthest{b.v > a.v ? low.u : high.u, b.u > a.u ? high.v : low.v};
  return signed_area(a, b, farthest) >= 0;
}

}  // namespace

bool CornerTree::Query::holds(const FlatCorner& p) const {
  if (p.vertex == a.vertex || p.vertex == b.vertex || p.vertex == c.vertex) return false;
  return signed_area(a, b, p) >= 0 && signed_area(b, c, p) >= 0 && signed_area(c, a, p) >= 0;
}

bool CornerTree::Query::may_overlap(const Node& node) const {
  const FlatCorner low{node.low_u, node.low_v}, high{node.high_u, node.high_v};
  const auto [least_u, most_u] = std::minmax({a.u, b.u, c.u});
  const auto [least_v, most_v] = std::minmax({a.v, b.v, c.v});
  return low.u <= most_u && high.u >= least_u && low.v <= most_v && high.v >= least_v &&
         reaches_left(a, b, low, high) && reaches_left(b, c, low, high) &&
         reaches_left(c, a, low, high);
}

CornerTree::CornerTree(std::span<const FlatCorner> polygon, std::vector<std::uint32_t> members)
    : polygon_(polygon), members_(std::move(members)), rank_(polygon.size(), kNoRank) {
  const auto count = static_cast<std::uint32_t>(members_.size());
  std::size_t leaves = 1;
  while (leaves * kLeafSize < count)
    leaves *= 2;
  nodes_.resize(2 * leaves - 1);
  build({0, 0, count});
  for (std::uint32_t i = 0; i < count; ++i)
    rank_[members_[i]] = i;
}

// Sorts the members of the range so that its halves lie on different sides of a line.
void CornerTree::build(Range range) {
  bound(range);
  if (range.is_leaf()) return;
  const Node& node = nodes_[range.node];
  const bool is_wide = node.high_u - node.low_u > node.high_v - node.low_v;
  const auto first = members_.begin() + range.first;
  std::nth_element(first, first + range.count / 2, first + range.count,
                   [&](std::uint32_t i, std::uint32_t j) {
                     const FlatCorner &p = polygon_[i], &q = polygon_[j];
                     return is_wide ? p.u < q.u : p.v < q.v;
                   });
  build(range.lower());
  build(range.upper());
}

void CornerTree::bound(Range range) {
  if (range.count == 0) return;
  const FlatCorner& start = polygon_[members_[range.first]];
  Node node{start.u, start.v, start.u, start.v, range.count};
  for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
    const FlatCorner& p = polygon_[members_[i]];
    node.low_u = std::min(node.low_u, p.u), node.high_u = std::max(node.high_u, p.u);
    node.low_v = std::min(node.low_v, p.v), node.high_v = std::max(node.high_v, p.v);
  }
  nodes_[range.node] = node;
}

void CornerTree::remove(std::uint32_t corner) {
  const std::uint32_t rank = std::exchange(rank_[corner], kNoRank);
  Range range{0, 0, static_cast<std::uint32_t>(members_.size())};
  --nodes_[0].left;
  while (!range.is_leaf()) {
    range = rank < range.upper().first ? range.lower() : range.upper();
    --nodes_[range.node].left;
  }
}

bool CornerTree::has_corner_in(const FlatCorner& a, const FlatCorner& b, const FlatCorner& c) {
  return search({a, b, c}, {0, 0, static_cast<std::uint32_t>(members_.size())});
}

bool CornerTree::search(const Query& query, Range range) {
  const Node& node = nodes_[range.node];
  ++visited_;
  if (node.left == 0 || !query.may_overlap(node)) return false;
  if (!range.is_leaf()) return search(query, range.lower()) || search(query, range.upper());
  const auto first = members_.begin() + range.first;
  return std::any_of(first, first + range.count, [&](std::uint32_t corner) {
    return has(corner) && query.holds(polygon_[corner]);
  });
}

}  // namespace vitrine::inline codec
