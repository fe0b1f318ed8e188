// SPDX-License-Identifier: Apache-2.0
#include "codec/import/weld.h"

#include <algorithm>
#include <numeric>

#include "codec/import/linear_colour.h"

namespace vitrine {
namespace {

// Three-way order of two vertices: by position, then by colour.
class VertexOrder {
 public:
  VertexOrder(const std::vector<Vec3>& positions, const std::vector<Colour>& colours)
      : positions_(positions), colours_(colours) {}

  int operator()(std::uint32_t a, std::uint32_t b) const {
    const Vec3 &p = positions_[a], &q = positions_[b];
    if (p.x != q.x) return p.x < q.x ? -1 : 1;
    if (p.y != q.y) return p.y < q.y ? -1 : 1;
    if (p.z != q.z) return p.z < q.z ? -1 : 1;
    if (colours_.empty() || colours_[a] == colours_[b]) return 0;
    return colours_[a] < colours_[b] ? -1 : 1;
  }

 private:
  const std::vector<Vec3>& positions_;
  const std::vector<Colour>& colours_;
};

}  // namespace

std::vector<std::uint32_t> weld(std::vector<Vec3>& positions, std::vector<Colour>& colours) {
  const VertexOrder order(positions, colours);
  std::vector<std::uint32_t> sorted(positions.size());
  std::iota(sorted.begin(), sorted.end(), 0);
  std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
    const int by_value = order(a, b);
    return by_value != 0 ? by_value < 0 : a < b;
  });
  // First the oldest equal vertex, then, in ascending order, that one's new index.
  std::vector<std::uint32_t> renamed(positions.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const bool equal = i > 0 && order(sorted[i - 1], sorted[i]) == 0;
    renamed[sorted[i]] = equal ? renamed[sorted[i - 1]] : sorted[i];
  }
  std::uint32_t kept = 0;
  for (std::uint32_t v = 0; v < renamed.size(); ++v) {
    if (renamed[v] != v) {
      renamed[v] = renamed[renamed[v]];
      continue;
    }
    positions[kept] = positions[v];
    if (!colours.empty()) colours[kept] = colours[v];
    renamed[v] = kept++;
  }
  positions.resize(kept);
  if (!colours.empty()) colours.resize(kept);
  return renamed;
}

std::vector<std::uint32_t> weld_and_blend(std::vector<Vec3>& positions,
                                          std::vector<Colour>& colours) {
  std::vector<Colour> none;
  std::vector<std::uint32_t> renamed = weld(positions, none);
  if (renamed.size() == positions.size()) return renamed;
  ColourMeans means(positions.size());
  for (std::size_t v = 0; v < renamed.size(); ++v)
    means.add(renamed[v], to_linear(colours[v]));
  colours = means.take();
  return renamed;
}

}  // namespace vitrine
