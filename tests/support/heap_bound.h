// SPDX-License-Identifier: Apache-2.0
// The most that hostile bytes may take of the heap, as the public headers state it.
#pragma once

#include <cstddef>

namespace vitrine::test {

struct HeapBound {
  std::size_t always, per_byte;

  std::size_t of(std::size_t bytes) const { return always + per_byte * bytes; }
};

// What refiner.h states, at 16 vertices a byte, and what the header's own records take.
inline constexpr HeapBound kDecodingHeap{1 << 20, 2'500};

// What read_mesh.h states, and a reader's own buffers and messages.
inline constexpr std::size_t kReaderAlways = 8 << 10;
inline constexpr HeapBound kReadingHeap{kReaderAlways, 64};
inline constexpr HeapBound kReadingGlbHeap{kReaderAlways, 128};
inline constexpr HeapBound kReadingCompressedHeap{kReaderAlways, 128 * 1'025};

}  // namespace vitrine::test
