// SPDX-License-Identifier: Apache-2.0
#include "codec/format/bound_text.h"

#include <gtest/gtest.h>

#include <string>

namespace vitrine {
namespace {

TEST(BoundText, HasFiveDigitsThatAreNeverBelowTheBound) {
  for (const double scale : {1e-7, 1e-3, 1.0, 1e4}) {
    for (double bound = scale; bound < 12 * scale; bound *= 1.000137) {
      const double named = std::stod(bound_text(bound));
      EXPECT_GE(named, bound);
      EXPECT_LE(named, bound * 1.0001001);
    }
  }
}

TEST(BoundText, LeavesAShortNumberAsItIs) {
  EXPECT_EQ(bound_text(0), "0");
  EXPECT_EQ(bound_text(0.5), "0.5");
  EXPECT_EQ(bound_text(0.10186), "0.10186");
}

}  // namespace
}  // namespace vitrine
