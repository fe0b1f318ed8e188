// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/order_in_space.h"

#include <algorithm>
#include <utility>

#include "codec/simplify/radix_sort.h"

namespace vitrine::inline codec {
namespace {

constexpr int kBits = 10;  // bits per coordinate

// Inserts two zero bits after each of the ten bits of `bits`.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16) & 0x0300'00FFu;
  bits = (bits | bits << 8) & 0x0300'F00Fu;
  bits = (bits | bits << 4) & 0x030C'30C3u;
  return (bits | bits << 2) & 0x0924'9249u;
}

std::vector<KeyedIndex> along_curve(const std::vector<Vec3>& positions) {
  Vec3 low = positions.front(), high = low;
  for (const Vec3& p : positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const double side = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  const auto cell = [&](double from) {
    return side > 0 ? spread(static_cast<std::uint32_t>(from / side * ((1 << kBits) - 1))) : 0;
  };
  std::vector<KeyedIndex> order;
  order.reserve(positions.size());
  for (const Vec3& p : positions) {
    const Vec3 r = p - low;
    order.push_back(
        {cell(r.x) | cell(r.y) << 1 | cell(r.z) << 2, static_cast<std::uint32_t>(order.size())});
  }
  return order;
}

template <typename T>
void permute(std::vector<T>& items, const std::vector<KeyedIndex>& order) {
  std::vector<T> permuted;
  permuted.reserve(order.size());
  for (const KeyedIndex& from : order)
    permuted.push_back(items[from.index]);
  items = std::move(permuted);
}

}  // namespace

std::vector<std::uint32_t> order_in_space(TriangleMesh& mesh) {
  if (mesh.positions.empty()) return {};
  std::vector<KeyedIndex> scratch, order = along_curve(mesh.positions);
  radix_sort(order, scratch);
  permute(mesh.positions, order);
  mesh.attributes =
      mesh.attributes.gather(order.size(), [&](std::size_t i) { return order[i].index; });
  std::vector<std::uint32_t> renamed(order.size());
  for (std::uint32_t v = 0; v < order.size(); ++v)
    renamed[order[v].index] = v;
  order.clear();
  for (Triangle& f : mesh.faces) {
    for (std::uint32_t& v : f)
      v = renamed[v];
    order.push_back({std::min({f[0], f[1], f[2]}), static_cast<std::uint32_t>(order.size())});
  }
  radix_sort(order, scratch);
  permute(mesh.faces, order);
  std::vector<std::uint32_t> before;
  before.reserve(order.size());
  for (const KeyedIndex& from : order)
    before.push_back(from.index);
  return before;
}

}  // namespace vitrine::inline codec
