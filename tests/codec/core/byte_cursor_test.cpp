// SPDX-License-Identifier: Apache-2.0
#include "codec/core/byte_cursor.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/random_mesh.h"

namespace vitrine {
namespace {

TEST(ByteCursor, EveryIntegerComesBack) {
  test::Dice dice(1);
  for (int i = 0; i < 20'000; ++i) {
    const std::uint64_t value = dice.bits() >> dice.below(64);
    const auto negative = static_cast<std::int64_t>(value ^ (dice.one_in(2) ? ~0ull : 0ull));
    ByteWriter out;
    out.varint(value);
    out.signed_varint(negative);
    out.u64(value);
    const auto bytes = out.take();
    ByteReader in(bytes);
    ASSERT_EQ(in.varint(), value);
    ASSERT_EQ(in.signed_varint(), negative);
    ASSERT_EQ(in.u64(), value);
    ASSERT_TRUE(in.is_ok());
    ASSERT_EQ(in.left(), 0u);
  }
}

TEST(ByteCursor, ReadingBeyondTheEndFailsForGood) {
  const std::vector<std::uint8_t> bytes = {1, 2, 3};
  ByteReader in(bytes);
  EXPECT_EQ(in.u32(), 0u);
  EXPECT_FALSE(in.is_ok());
  EXPECT_EQ(in.u8(), 0u);
  EXPECT_TRUE(in.bytes(std::numeric_limits<std::size_t>::max()).empty());
}

TEST(ByteCursor, AnOverlongVariableIntegerIsAnError) {
  const std::vector<std::uint8_t> most = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 1};
  ByteReader in(most);
  EXPECT_EQ(in.varint(), std::numeric_limits<std::uint64_t>::max());
  EXPECT_TRUE(in.is_ok());
  std::vector<std::uint8_t> more = most;
  more.back() = 2;
  ByteReader beyond(more);
  EXPECT_EQ(beyond.varint(), 0u);
  EXPECT_FALSE(beyond.is_ok());
}

TEST(ByteCursor, AVariableIntegerOf32BitsTakesAtMostFiveBytes) {
  const std::vector<std::uint8_t> most = {0xFF, 0xFF, 0xFF, 0xFF, 0x0F};
  ByteReader in(most);
  EXPECT_EQ(in.varint32(), std::numeric_limits<std::uint32_t>::max());
  EXPECT_TRUE(in.is_ok());
  using Bytes = std::vector<std::uint8_t>;
  for (const Bytes& more :
       {Bytes{0xFF, 0xFF, 0xFF, 0xFF, 0x1F}, {0x81, 0x80, 0x80, 0x80, 0x80, 0}}) {
    ByteReader beyond(more);
    EXPECT_EQ(beyond.varint32(), 0u);
    EXPECT_FALSE(beyond.is_ok());
  }
}

}  // namespace
}  // namespace vitrine
