// SPDX-License-Identifier: Apache-2.0
#include "server/stream/slice.h"

#include <gtest/gtest.h>

namespace vitrine {
namespace {

TEST(SliceHeader, IsLittleEndian) {
  const ChunkInfo chunk{.level = 0x0102, .region = 0x0304, .length = 0x05060708};
  const Slice slice{.chunk = 9, .offset = 0x0a0b0c0d, .length = 1};
  const SliceHeader expected = {0x02, 0x01, 0x04, 0x03, 0x0d, 0x0c,
                                0x0b, 0x0a, 0x08, 0x07, 0x06, 0x05};
  EXPECT_EQ(slice_header(chunk, slice), expected);
}

}  // namespace
}  // namespace vitrine
