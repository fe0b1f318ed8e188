// SPDX-License-Identifier: Apache-2.0
#include "codec/core/fill_in.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace vitrine {
namespace {

TEST(FillIn, NumbersTakeThePlacesInTheirOrder) {
  EXPECT_EQ(fill_in("{} of {} bytes", {0, 1230}), "0 of 1230 bytes");
  EXPECT_EQ(fill_in("{}", {UINT64_MAX}), "18446744073709551615");
}

TEST(FillIn, APlaceWithoutANumberStays) {
  EXPECT_EQ(fill_in("nothing", {}), "nothing");
  EXPECT_EQ(fill_in("{} and {}", {7}), "7 and {}");
}

}  // namespace
}  // namespace vitrine
