// SPDX-License-Identifier: Apache-2.0
// Checks the form of notes about changes and losses. The helpers of import and repair tests call
// it, so it checks every note that occurs in these tests.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace vitrine::testing {

// Expects that each line contains a number and, after a semicolon, the next step for the user.
inline void expect_counts_and_steps(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    EXPECT_TRUE(std::ranges::any_of(line, [](char c) { return c >= '0' && c <= '9'; })) << line;
    EXPECT_THAT(line, ::testing::HasSubstr("; "));
    EXPECT_THAT(line, ::testing::Not(::testing::HasSubstr("\n")));
  }
}

}  // namespace vitrine::testing
