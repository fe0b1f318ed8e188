// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/visiting_order.h"

#include <algorithm>
#include <numeric>
#include <utility>

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

// In place and never slow, in a few bytes of the browser's module.
template <class Before>
void heap_sort(std::span<VertexId> items, const Before& before) {
  const auto sift = [&](std::size_t hole, std::size_t size) {
    const VertexId item = items[hole];
    for (std::size_t child; (child = 2 * hole + 1) < size; hole = child) {
      if (child + 1 < size && before(items[child], items[child + 1])) ++child;
      if (!before(item, items[child])) break;
      items[hole] = items[child];
    }
    items[hole] = item;
  };
  for (std::size_t k = items.size() / 2; k-- > 0;)
    sift(k, items.size());
  for (std::size_t size = items.size(); size-- > 1;) {
    std::swap(items[0], items[size]);
    sift(0, size);
  }
}

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
    heap_sort(std::span(order).subspan(begin, end[slab] - begin), [&](VertexId a, VertexId b) {
      return positions[a] != positions[b] ? positions[a] > positions[b] : a < b;
    });
  }
  return order;
}

}  // namespace vitrine
