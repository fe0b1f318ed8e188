// SPDX-License-Identifier: Apache-2.0
#include "server/sandbox/page_ranges.h"

#include <algorithm>

namespace vitrine::server {

std::optional<std::size_t> PageRanges::take(std::size_t size) {
  const std::size_t pages = (size + kPage - 1) / kPage * kPage;
  const auto shortest = by_length_.lower_bound({pages, 0});
  if (shortest == by_length_.end()) return std::nullopt;
  const auto [length, offset] = *shortest;
  forget(free_.find(offset));
  if (length > pages) release(offset + pages, length - pages);
  taken_.emplace(offset, pages);
  taken_bytes_ += pages;
  end_ = std::max(end_, offset + pages);
  return offset;
}

std::size_t PageRanges::give_back(std::size_t offset) {
  const auto range = taken_.find(offset);
  const std::size_t size = range->second;
  taken_.erase(range);
  taken_bytes_ -= size;
  release(offset, size);
  return size;
}

// Adds a free range and joins it with adjacent free ranges.
void PageRanges::release(std::size_t offset, std::size_t size) {
  const auto after = free_.find(offset + size);
  if (after != free_.end()) size += after->second, forget(after);
  const auto above = free_.lower_bound(offset);
  if (above != free_.begin()) {
    const auto before = std::prev(above);
    if (before->first + before->second == offset) {
      offset = before->first, size += before->second;
      forget(before);
    }
  }
  if (size == 0) return;
  free_.emplace(offset, size);
  by_length_.emplace(size, offset);
}

void PageRanges::forget(std::map<std::size_t, std::size_t>::iterator range) {
  by_length_.erase({range->second, range->first});
  free_.erase(range);
}

}  // namespace vitrine::server
