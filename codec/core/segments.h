// SPDX-License-Identifier: Apache-2.0
// An array that grows at its end in blocks of equal size. Unlike std::vector, it never moves its
// elements, so growing needs no second copy and does not fragment memory. At most one block is
// partly unused after growing. Shrinking frees no blocks.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace vitrine::inline codec {

// Prefetches the memory at `place`. Does nothing on WebAssembly, which has no prefetch instruction.
inline void fetch([[maybe_unused]] const void* place) {
#ifndef __wasm__
  __builtin_prefetch(place);
#endif
}

template <class T>
class Segments {
 public:
  static constexpr std::size_t kBlock = 2048;  // elements per block

  Segments() = default;
  Segments(Segments&& other) noexcept
      : blocks_(std::move(other.blocks_)), size_(std::exchange(other.size_, 0)) {}
  Segments& operator=(Segments&& other) noexcept {
    blocks_ = std::move(other.blocks_);
    size_ = std::exchange(other.size_, 0);
    return *this;
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  T& operator[](std::size_t i) { return blocks_[i / kBlock][i % kBlock]; }
  const T& operator[](std::size_t i) const { return blocks_[i / kBlock][i % kBlock]; }

  void push_back(const T& value) {
    if (blocks_.size() * kBlock == size_) add_block();
    (*this)[size_++] = value;
  }
  void pop_back() { --size_; }

  // Sets the number of elements. New elements are copies of `value`.
  void resize(std::size_t size, const T& value) {
    while (blocks_.size() * kBlock < size)
      add_block();
    for (; size_ < size; ++size_)
      (*this)[size_] = value;
    size_ = size;
  }

  // Returns all elements in one contiguous vector.
  std::vector<T> flat() const {
    std::vector<T> out(size_);
    for (std::size_t i = 0; i < size_; ++i)
      out[i] = (*this)[i];
    return out;
  }

 private:
  void add_block() { blocks_.push_back(std::unique_ptr<T[]>(new T[kBlock])); }

  std::vector<std::unique_ptr<T[]>> blocks_;
  std::size_t size_ = 0;
};

}  // namespace vitrine::inline codec
