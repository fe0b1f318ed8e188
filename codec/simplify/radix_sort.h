// SPDX-License-Identifier: Apache-2.0
// Stable radix sort of pairs of a key and an index.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace vitrine::inline codec {

struct KeyedIndex {
  std::uint32_t key;
  std::uint32_t index;
};

// Sorts `items` by key. Items with equal keys keep their order. `scratch` is working memory; its
// size changes.
inline void radix_sort(std::vector<KeyedIndex>& items, std::vector<KeyedIndex>& scratch) {
  constexpr int kBits = 11, kPasses = 3;
  constexpr std::uint32_t kBuckets = 1u << kBits;
  std::array<std::array<std::uint32_t, kBuckets>, kPasses> start{};
  for (const KeyedIndex& item : items) {
    for (int p = 0; p < kPasses; ++p)
      ++start[p][item.key >> (kBits * p) & (kBuckets - 1)];
  }
  scratch.resize(items.size());
  for (int p = 0; p < kPasses; ++p) {
    const bool all_same =
        !items.empty() && start[p][items[0].key >> (kBits * p) & (kBuckets - 1)] == items.size();
    if (all_same) continue;
    std::uint32_t sum = 0;
    for (std::uint32_t& s : start[p])
      sum += std::exchange(s, sum);
    for (const KeyedIndex& item : items) {
      scratch[start[p][item.key >> (kBits * p) & (kBuckets - 1)]++] = item;
    }
    items.swap(scratch);
  }
}

}  // namespace vitrine::inline codec
