// SPDX-License-Identifier: Apache-2.0
// Which parts of a large piece of address space are taken: ranges of whole pages.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace vitrine {

class PageRanges {
 public:
  static constexpr std::size_t kPage = 4096;

  // [0, size) is free, in whole pages.
  explicit PageRanges(std::size_t size) { release(0, size / kPage * kPage); }

  // The offset of `size` (> 0) bytes, rounded up to pages, that are taken from now on; nothing
  // where no free range is as long. The shortest one that is long enough, so that long ones last.
  std::optional<std::size_t> take(std::size_t size);

  // `offset` is what take() gave. Returns the range's size.
  std::size_t give_back(std::size_t offset);

  std::size_t taken() const { return taken_bytes_; }
  std::size_t end() const { return end_; }  // no range taken so far has ended beyond

 private:
  void release(std::size_t offset, std::size_t size);
  void forget(std::map<std::size_t, std::size_t>::iterator range);

  std::map<std::size_t, std::size_t> taken_, free_;          // offset and size
  std::set<std::pair<std::size_t, std::size_t>> by_length_;  // of free_: size and offset
  std::size_t taken_bytes_ = 0, end_ = 0;
};

}  // namespace vitrine
