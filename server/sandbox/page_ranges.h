// SPDX-License-Identifier: Apache-2.0
// Allocates ranges of whole pages in a large address space.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace vitrine::server {

class PageRanges {
 public:
  static constexpr std::size_t kPage = 4096;

  // Creates the allocator with one free range [0, size), rounded down to whole pages.
  explicit PageRanges(std::size_t size) { release(0, size / kPage * kPage); }

  // Allocates `size` (> 0) bytes, rounded up to whole pages. Returns the offset, or nullopt if no
  // free range is long enough. Uses the shortest free range that is long enough, so that long
  // ranges are kept for large blocks.
  std::optional<std::size_t> take(std::size_t size);

  // Frees the range at `offset`, a result of take(). Returns the size of the range.
  std::size_t give_back(std::size_t offset);

  std::size_t taken() const { return taken_bytes_; }
  std::size_t end() const { return end_; }  // highest end of any range allocated so far

 private:
  void release(std::size_t offset, std::size_t size);
  void forget(std::map<std::size_t, std::size_t>::iterator range);

  std::map<std::size_t, std::size_t> taken_, free_;          // sizes of ranges by their offset
  std::set<std::pair<std::size_t, std::size_t>> by_length_;  // size and offset of each free range
  std::size_t taken_bytes_ = 0, end_ = 0;
};

}  // namespace vitrine::server
