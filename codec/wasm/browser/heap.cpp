// SPDX-License-Identifier: Apache-2.0
// A heap that replaces that of wasi-libc, which has ten times as much code. Allocates by best fit
// and merges adjacent free blocks. Memory grows by at least a sixteenth at a time, because browsers
// collect garbage each time memory grows.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>

extern "C" char __heap_base;  // set by the linker: first byte after data and stack

namespace {

constexpr std::size_t kPage = 65536;
constexpr std::size_t kShare = 16;
// Alignment of allocations, in bytes. Block sizes are multiples of kUnit.
constexpr std::size_t kUnit = 16;
constexpr std::size_t kMost = std::size_t{1} << 31;

struct Block {
  std::size_t size_before;  // size of the preceding block in memory
  // Size in bytes, including both size members. The lowest bit is set while the block is in use.
  std::size_t size;
  // If the block is in use, the allocation begins at the address of `next`. If it is free, `next`
  // and `last` are its links in the free list.
  Block* next;
  Block* last;

  Block* at(std::size_t offset) {
    return reinterpret_cast<Block*>(reinterpret_cast<char*>(this) + offset);
  }
  bool is_in_use() const { return (size & 1) != 0; }
};
constexpr std::size_t kHeader = offsetof(Block, next);

Block free_blocks{0, 0, &free_blocks, &free_blocks};
Block* end = nullptr;  // header behind the last block: an empty block marked as in use

void unlink(Block* block) {
  block->last->next = block->next;
  block->next->last = block->last;
}

// Adds a free block of `size` bytes at `block` to the free list. Both adjacent blocks must be in
// use.
void link(Block* block, std::size_t size) {
  block->size = block->at(size)->size_before = size;
  block->next = free_blocks.next;
  block->last = &free_blocks;
  block->next->last = free_blocks.next = block;
}

void give_back(Block* block, std::size_t size) {
  Block* const behind = block->at(size);
  if (!behind->is_in_use()) unlink(behind), size += behind->size;
  Block* const before = block->at(-block->size_before);
  if (!before->is_in_use()) unlink(before), size += before->size, block = before;
  link(block, size);
}

bool add_pages(std::size_t count) {
  return __builtin_wasm_memory_grow(0, count) != SIZE_MAX;
}

bool grow(std::size_t size) {
  const std::size_t there = __builtin_wasm_memory_size(0), pages = size / kPage + 1;
  if (!add_pages(std::max(pages, there / kShare)) && !add_pages(pages)) return false;
  // The first call places a sentinel before the first block. The sentinel is marked as in use, so
  // that merging stops at it.
  if (end == nullptr) {
    const auto base = (reinterpret_cast<std::uintptr_t>(&__heap_base) + kUnit - 1) & -kUnit;
    auto* const front = reinterpret_cast<Block*>(base + kHeader);
    front->size = kUnit + 1;
    end = front->at(kUnit);
    end->size_before = kUnit;
  }
  Block* const fresh = end;
  end = reinterpret_cast<Block*>(__builtin_wasm_memory_size(0) * kPage - kHeader);
  end->size = 1;
  give_back(fresh, reinterpret_cast<std::uintptr_t>(end) - reinterpret_cast<std::uintptr_t>(fresh));
  return true;
}

Block* smallest_for(std::size_t size) {
  Block* found = nullptr;
  for (Block* b = free_blocks.next; b != &free_blocks; b = b->next) {
    if (b->size >= size && (found == nullptr || b->size < found->size)) found = b;
  }
  return found;
}

}  // namespace

void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  if (bytes > kMost) return nullptr;
  const std::size_t size = (std::max(bytes, kUnit - kHeader) + kHeader + kUnit - 1) & -kUnit;
  Block* block = smallest_for(size);
  if (block == nullptr) {
    if (!grow(size)) return nullptr;
    block = smallest_for(size);
  }
  unlink(block);
  const std::size_t left = block->size - size;
  if (left != 0) link(block->at(size), left);
  block->at(size)->size_before = size;
  block->size = size + 1;
  return &block->next;
}
void* operator new(std::size_t bytes) {
  void* const pointer = operator new(bytes, std::nothrow);
  if (pointer == nullptr) __builtin_trap();
  return pointer;
}
void* operator new[](std::size_t bytes) {
  return operator new(bytes);
}

void operator delete(void* pointer) noexcept {
  if (pointer == nullptr) return;
  Block* const block = reinterpret_cast<Block*>(static_cast<char*>(pointer) - kHeader);
  give_back(block, block->size - 1);
}
void operator delete[](void* pointer) noexcept {
  operator delete(pointer);
}
