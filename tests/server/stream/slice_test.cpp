// SPDX-License-Identifier: Apache-2.0
#include "server/stream/slice.h"

#include <gtest/gtest.h>

#include <vector>

namespace vitrine::server {
namespace {

constexpr SliceHeader kHeader{.model = 0x0102,
                              .level = 0x0304,
                              .region = 0x05060708,
                              .offset = 0x0a0b0c0d,
                              .total = 0x0a0b0c0f};

std::vector<std::uint8_t> frame(const SliceHeader& header, std::size_t payload) {
  const auto bytes = to_bytes(header);
  std::vector<std::uint8_t> frame(bytes.begin(), bytes.end());
  frame.resize(bytes.size() + payload, 7);
  return frame;
}

TEST(SliceHeader, IsLittleEndian) {
  const std::array<std::uint8_t, kSliceHeader> expected = {0x02, 0x01, 0x04, 0x03, 0x08, 0x07,
                                                           0x06, 0x05, 0x0d, 0x0c, 0x0b, 0x0a,
                                                           0x0f, 0x0c, 0x0b, 0x0a};
  EXPECT_EQ(to_bytes(kHeader), expected);
}

TEST(SliceHeader, IsReadAgain) {
  EXPECT_EQ(parse_slice(frame(kHeader, 1)), kHeader);
  EXPECT_EQ(parse_slice(frame(kHeader, 2)), kHeader);
}

TEST(SliceHeader, OfAFrameThatIsNoSliceIsRefused) {
  EXPECT_FALSE(parse_slice({}));
  EXPECT_FALSE(parse_slice(frame(kHeader, 0))) << "nothing behind it";
  EXPECT_FALSE(parse_slice(frame(kHeader, 3))) << "more than the chunk has";
  const SliceHeader large{.total = kMaxSlice + 1};
  EXPECT_TRUE(parse_slice(frame(large, kMaxSlice)));
  EXPECT_FALSE(parse_slice(frame(large, kMaxSlice + 1)));
  EXPECT_FALSE(parse_slice(frame({.offset = UINT32_MAX, .total = 3}, 4))) << "no overflow";
}

}  // namespace
}  // namespace vitrine::server
