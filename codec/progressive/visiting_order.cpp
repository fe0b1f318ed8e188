// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/visiting_order.h"

#include <algorithm>
#include <numeric>

namespace vitrine {
namespace {

// Slabs of equal width across x, in descending order and at most as many as there are vertices:
// sorting within each takes few comparisons.
struct Slabs {
  std::int32_t high = -kCoordinateBound, low = kCoordinateBound;  // of x
  std::uint32_t shift = 0;

  Slabs(const Segments<Vec3i>& positions, std::span<const VertexId> members) {
    for (const VertexId v : members) {
      high = std::max(high, positions[v].x);
      low = std::min(low, positions[v].x);
    }
    while (count() > members.size() && count() > 1)
      ++shift;
  }
  std::size_t of(const Vec3i& p) const { return static_cast<std::size_t>((high - p.x) >> shift); }
  std::size_t count() const { return static_cast<std::size_t>((high - low) >> shift) + 1; }
};

}  // namespace

std::vector<VertexId> visiting_order(const Segments<Vec3i>& positions,
                                     std::span<const VertexId> members) {
  std::vector<VertexId> order(members.size());
  if (members.empty()) return order;
  const Slabs slabs(positions, members);
  std::vector<std::uint32_t> end(slabs.count() + 1, 0);  // of the slab before
  for (const VertexId v : members)
    ++end[slabs.of(positions[v]) + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  for (const VertexId v : members)
    order[end[slabs.of(positions[v])]++] = v;
  std::uint32_t begin = 0;
  for (std::size_t slab = 0; slab < slabs.count(); begin = end[slab++]) {
    std::sort(order.begin() + begin, order.begin() + end[slab], [&](VertexId a, VertexId b) {
      return positions[a] != positions[b] ? positions[a] > positions[b] : a < b;
    });
  }
  return order;
}

}  // namespace vitrine
