// SPDX-License-Identifier: Apache-2.0
#include "codec/core/parse_number.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace vitrine {
namespace {

TEST(ParseNumber, TakesTheWholeTextOrNothing) {
  EXPECT_EQ(parse_number<std::uint32_t>("0"), 0u);
  EXPECT_EQ(parse_number<std::uint32_t>("4294967295"), 4294967295u);
  EXPECT_EQ(parse_number<double>("2.5e3"), 2500);
  for (const char* text : {"", " 1", "1 ", "+1", "1x", "x1", "-1", "1.5", "0x10"})
    EXPECT_EQ(parse_number<std::uint32_t>(text), std::nullopt) << text;
}

TEST(ParseNumber, WhatDoesNotFitIsNone) {
  EXPECT_EQ(parse_number<std::uint32_t>("4294967296"), std::nullopt);
  EXPECT_EQ(parse_number<std::uint64_t>("99999999999999999999"), std::nullopt);
  EXPECT_EQ(parse_number<double>("1e999"), std::nullopt);
}

}  // namespace
}  // namespace vitrine
