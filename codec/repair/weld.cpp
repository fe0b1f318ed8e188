// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/weld.h"

#include <numeric>

#include "codec/core/linear_colour.h"

namespace vitrine::inline codec {

int VertexOrder::operator()(std::uint32_t a, std::uint32_t b) const {
  const Vec3 &p = positions_[a], &q = positions_[b];
  if (p.x != q.x) return p.x < q.x ? -1 : 1;
  if (p.y != q.y) return p.y < q.y ? -1 : 1;
  if (p.z != q.z) return p.z < q.z ? -1 : 1;
  const auto order = attributes_.row(a) <=> attributes_.row(b);
  return order == 0 ? 0 : order < 0 ? -1 : 1;
}

void merge_into_older(std::vector<std::uint32_t>& older, std::vector<Vec3>& positions,
                      VertexAttributes& attributes) {
  std::uint32_t kept = 0;
  for (std::uint32_t v = 0; v < older.size(); ++v) {
    if (older[v] != v) {
      older[v] = older[older[v]];
      continue;
    }
    positions[kept] = positions[v];
    attributes.copy(kept, v);
    older[v] = kept++;
  }
  positions.resize(kept);
  attributes.truncate(kept);
}

std::vector<std::uint32_t> weld(std::vector<Vec3>& positions, VertexAttributes& attributes) {
  std::vector<std::uint32_t> all(positions.size()), renamed(positions.size());
  std::iota(all.begin(), all.end(), 0);
  VertexOrder(positions, attributes)
      .for_each_oldest(std::move(all),
                       [&](std::uint32_t v, std::uint32_t oldest) { renamed[v] = oldest; });
  merge_into_older(renamed, positions, attributes);
  return renamed;
}

std::vector<Colour> blended(const std::vector<std::uint32_t>& renamed, std::size_t count,
                            const std::vector<Colour>& colours) {
  ColourMeans means(count);
  for (std::size_t v = 0; v < renamed.size(); ++v)
    means.add(renamed[v], to_linear(colours[v]));
  return means.take();
}

}  // namespace vitrine::inline codec
