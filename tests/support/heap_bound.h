// SPDX-License-Identifier: Apache-2.0
// Defines upper bounds of the heap memory that the codec uses for hostile bytes. The public headers
// promise these bounds.
#pragma once

#include <cstddef>

namespace vitrine::test {

struct HeapBound {
  std::size_t always, per_byte;

  std::size_t of(std::size_t bytes) const { return always + per_byte * bytes; }
};

// The bound in refiner.h for a chunk that adds the maximum of 16 vertices per byte, plus the memory
// for the parsed header.
inline constexpr HeapBound kDecodingHeap{1 << 20, 2'500};

// The bound for a textured model. To undo a split of valence 24, the refiner may save 24 wedges of
// 12 bytes. A face may have three wedges of its own.
inline constexpr HeapBound kDecodingTextureHeap{1 << 20, 9'500};

// The bound in base_decoder.h, plus the memory for error messages.
inline constexpr HeapBound kBaseHeap{4 << 10, 1'000};

// The bound in read_mesh.h, plus the memory for a reader's own buffers and messages.
inline constexpr std::size_t kReaderAlways = 8 << 10;
inline constexpr HeapBound kReadingHeap{kReaderAlways, 64};
inline constexpr HeapBound kReadingGlbHeap{kReaderAlways, 128};
inline constexpr HeapBound kReadingCompressedHeap{kReaderAlways, 128 * 1'025};
// The bound for FBX, plus the memory of Assimp's importers.
inline constexpr HeapBound kReadingFbxHeap{1 << 19, 128 * 1'025};

}  // namespace vitrine::test
