// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/edge_groups.h"

#include <algorithm>

namespace vitrine::inline codec {

// Sorts the edges by their smaller vertex, using counting sort. Then sorts the few edges of each
// vertex by their larger vertex.
EdgeGroups::EdgeGroups(std::size_t vertex_count, std::span<const Triangle> faces)
    : begin_(vertex_count + 1, 0), sides_(3 * faces.size()) {
  for (const auto& [a, b, c] : faces) {
    ++begin_[std::min(a, b)], ++begin_[std::min(b, c)], ++begin_[std::min(c, a)];
  }
  std::uint32_t total = 0;
  for (std::uint32_t& begin : begin_)
    total += begin, begin = total;
  for (std::size_t f = faces.size(); f-- > 0;) {
    for (std::uint32_t k = 3; k-- > 0;) {
      const std::uint32_t from = faces[f][(k + 1) % 3], to = faces[f][(k + 2) % 3];
      sides_[--begin_[std::min(from, to)]] = {std::max(from, to),
                                              static_cast<std::uint32_t>(3 * f + k)};
    }
  }
  for (std::size_t v = 0; v < vertex_count; ++v) {
    std::sort(sides_.begin() + begin_[v], sides_.begin() + begin_[v + 1],
              [](const EdgeSide& a, const EdgeSide& b) {
                return a.high != b.high ? a.high < b.high : a.corner < b.corner;
              });
  }
}

}  // namespace vitrine::inline codec
