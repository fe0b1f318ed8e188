// SPDX-License-Identifier: Apache-2.0
#include "codec/core/sha256.h"

#include <gtest/gtest.h>

#include <vector>

namespace vitrine {
namespace {

std::string hash(std::string_view text) {
  return to_hex(sha256({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
}

// Hashes the examples of FIPS 180-4, and one input for each kind of padding.
TEST(Sha256, KnowsTheStandardVectors) {
  EXPECT_EQ(hash(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hash("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hash("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(hash("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmnhijklmnoijklmnopjklmnopqk"
                 "lmnopqrlmnopqrsmnopqrstnopqrstu"),
            "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
  EXPECT_EQ(hash(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, PiecesOfAnySizeHaveTheHashOfTheWhole) {
  std::vector<std::uint8_t> bytes(300);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::uint8_t>(i * i);
  for (std::size_t first = 0; first <= bytes.size(); ++first) {
    for (const std::size_t piece : {1u, 55u, 63u, 64u, 65u, 130u}) {
      Sha256Hasher hasher;
      hasher.add(std::span(bytes).first(first));
      for (std::size_t at = first; at < bytes.size(); at += piece)
        hasher.add(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)));
      ASSERT_EQ(hasher.finish(), sha256(bytes)) << first << " bytes, then pieces of " << piece;
    }
  }
}

TEST(Sha256, HexIsReadBackAndNothingElse) {
  const Sha256 digest = sha256({});
  Sha256 read{};
  ASSERT_TRUE(from_hex(to_hex(digest), read));
  EXPECT_EQ(read, digest);
  EXPECT_FALSE(from_hex(to_hex(digest).substr(1), read));
  EXPECT_FALSE(from_hex(std::string(64, 'G'), read));
  EXPECT_FALSE(from_hex(std::string(64, 'A'), read));
  for (std::size_t at = 0; at < 64; ++at) {
    for (const char wrong : {'g', '/', ':', '`', ' ', '\xff'}) {
      std::string text(64, 'f');
      text[at] = wrong;
      EXPECT_FALSE(from_hex(text, read)) << at;
    }
  }
}

}  // namespace
}  // namespace vitrine
