// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/fabscan.h"

#include <gtest/gtest.h>

namespace vitrine::acquisition::fabscan {
namespace {

TEST(FabScan, SaysWhatTheFirmwareReads) {
  EXPECT_EQ(turn(-4), "G02 T-4 F200");
}

TEST(FabScan, KnowsItsVersions) {
  EXPECT_TRUE(is_version("v.20160506"));
  EXPECT_TRUE(is_version("v2.1"));
  for (const char* line : {"", "v", "v.", "version", "20160506", "error: v.1"})
    EXPECT_FALSE(is_version(line)) << line;
}

}  // namespace
}  // namespace vitrine::acquisition::fabscan
