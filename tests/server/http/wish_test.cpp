// SPDX-License-Identifier: Apache-2.0
#include "server/http/wish.h"

#include <gtest/gtest.h>

namespace vitrine {
namespace {

Manifest large_manifest() {
  Manifest manifest;
  manifest.levels.resize(3);
  manifest.levels.back().faces = 1'000'000;
  manifest.file_bytes = 2'000'000;
  return manifest;
}

Wish wish_of(std::string_view query, const char* save_data = nullptr) {
  RequestHeader header;
  if (save_data != nullptr) header.set("Save-Data", save_data);
  return read_wish(Query::parse(query).value(), header, large_manifest()).value();
}

TEST(Wish, WithoutAWordItIsTheWhole) {
  EXPECT_EQ(std::get<WantLevel>(wish_of("").want).level, 2u);
  EXPECT_FALSE(wish_of("").stated);
  EXPECT_EQ(std::get<WantLevel>(wish_of("", "off").want).level, 2u);
}

TEST(Wish, WhoSavesDataGetsAMegabyteUnlessTheyAskForMore) {
  EXPECT_EQ(std::get<WantBytes>(wish_of("", "on").want).bytes, kSavedDataBytes);
  EXPECT_EQ(std::get<WantBytes>(wish_of("", "ON").want).bytes, kSavedDataBytes);
  EXPECT_EQ(std::get<WantLevel>(wish_of("level=highest", "on").want).level, 2u);
}

TEST(Wish, ALineCarriesItsKilobitsInItsSeconds) {
  const Wish wish = wish_of("kbps=800&seconds=2.5");
  EXPECT_EQ(std::get<WantBytes>(wish.want).bytes, 250'000u);
  EXPECT_EQ(wish.kbps, 800);
}

TEST(Wish, EqualOnesHaveEqualKeys) {
  const auto key = [](std::string_view query) {
    return key_of(wish_of(query).want, large_manifest());
  };
  EXPECT_EQ(key("triangles=2000000"), key("triangles=1000000"));
  EXPECT_EQ(key("error=0.50"), key("error=.5"));
  EXPECT_EQ(key("level=highest"), key("level=2"));
  EXPECT_NE(key("triangles=10"), key("bytes=10"));
}

}  // namespace
}  // namespace vitrine
