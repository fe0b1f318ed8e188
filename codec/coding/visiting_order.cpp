// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/visiting_order.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace vitrine::inline codec {
namespace {

// Divides the x axis into slabs of equal width, in descending order of x. There are at most as many
// slabs as vertices. Most slabs hold few vertices and are therefore quick to sort.
struct Slabs {
  std::int32_t high = -kCoordinateBound, low = kCoordinateBound;  // bounds of the x coordinates
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

// Heap sort: works in place, has no quadratic worst case, and adds few bytes to the browser's
// module.
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
  // Per slab: the next free index in `order`. It begins as the start of the slab and becomes the
  // end of the slab once all vertices are placed.
  std::vector<std::uint32_t> end(slabs.count() + 1, 0);
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

}  // namespace vitrine::inline codec
