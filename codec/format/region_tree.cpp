// SPDX-License-Identifier: Apache-2.0
#include "codec/format/region_tree.h"

namespace vitrine::inline codec {
namespace {

// Returns the number of nodes of a tree with `leaves` leaves.
constexpr std::uint32_t size_of(std::uint32_t leaves) {
  return 2 * leaves - 1;
}

}  // namespace

bool RegionTree::link() {
  const auto count = static_cast<std::uint32_t>(nodes.size());
  std::uint32_t leaf = 0;
  for (RegionNode& node : nodes) {
    node.first = leaf;
    leaf += node.fork == 0 ? 1 : 0;
  }
  for (std::uint32_t i = count; i-- > 0;) {
    RegionNode& node = nodes[i];
    node.leaves = 1;
    if (node.fork == 0) continue;
    if (i + 1 >= count) return false;
    node.second = i + 1 + size_of(nodes[i + 1].leaves);
    if (node.second >= count) return false;
    for (const std::uint32_t child : {i + 1, node.second}) {
      if (nodes[child].fork != 0 && nodes[child].fork < node.fork) return false;
    }
    node.leaves = nodes[i + 1].leaves + nodes[node.second].leaves;
  }
  return count > 0 && size_of(leaves()) == count;
}

std::vector<std::uint32_t> RegionTree::regions_at(std::uint32_t level) const {
  std::vector<std::uint32_t> regions;
  for (std::uint32_t i = 0; i < nodes.size();) {
    if (nodes[i].forks_by(level)) {
      ++i;
    } else {
      regions.push_back(i);
      i += size_of(nodes[i].leaves);
    }
  }
  return regions;
}

}  // namespace vitrine::inline codec
