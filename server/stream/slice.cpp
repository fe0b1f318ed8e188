// SPDX-License-Identifier: Apache-2.0
#include "server/stream/slice.h"

namespace vitrine {
namespace {

template <std::size_t At, std::size_t Bytes>
void put(SliceHeader& header, std::uint64_t value) {
  for (std::size_t i = 0; i < Bytes; ++i)
    header[At + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

}  // namespace

SliceHeader slice_header(const ChunkInfo& chunk, const Slice& slice) {
  SliceHeader header{};
  put<0, 2>(header, chunk.level);
  put<2, 2>(header, chunk.region);
  put<4, 4>(header, slice.offset);
  put<8, 4>(header, chunk.length);
  return header;
}

}  // namespace vitrine
