// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/keep_vertices.h"

#include <algorithm>

namespace vitrine::inline codec {

std::size_t keep_vertices(const std::vector<bool>& keep, std::vector<Vec3>& positions,
                          VertexAttributes& attributes, std::span<Triangle> faces) {
  if (std::find(keep.begin(), keep.end(), false) == keep.end()) return 0;
  std::vector<std::uint32_t> renamed(keep.size());
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < keep.size(); ++v) {
    if (!keep[v]) continue;
    positions[kept] = positions[v];
    attributes.copy(kept, v);
    renamed[v] = kept++;
  }
  positions.resize(kept);
  attributes.truncate(kept);
  for (Triangle& face : faces) {
    for (std::uint32_t& v : face)
      v = renamed[v];
  }
  return keep.size() - kept;
}

std::vector<bool> used_vertices(std::size_t count, std::span<const Triangle> faces) {
  std::vector<bool> used(count, false);
  for (const Triangle& face : faces) {
    for (const std::uint32_t v : face)
      used[v] = true;
  }
  return used;
}

}  // namespace vitrine::inline codec
