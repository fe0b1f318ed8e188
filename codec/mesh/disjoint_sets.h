// SPDX-License-Identifier: Apache-2.0
// Disjoint sets of numbers, which can be merged in pairs (union-find).
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace vitrine::inline codec {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    for (std::uint32_t i = 0; i < count; ++i)
      parent_[i] = i;
  }

  // Returns the smallest number in the set that contains i.
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // Joins the sets of a and b. Returns false if a and b already were in the same set.
  bool join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace vitrine::inline codec
