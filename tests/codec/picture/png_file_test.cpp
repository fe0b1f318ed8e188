// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/write_picture.h"

#include <gmock/gmock.h>

namespace vitrine {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// The error must not say what to do next, because the codec does not know which command runs.
TEST(PngFile, ThePictureWithoutPixelsIsRefusedWithTheReasonAlone) {
  const auto file = write_png({});
  ASSERT_FALSE(file);
  EXPECT_THAT(file.error().message, StartsWith("the picture cannot be written as PNG: "));
  EXPECT_THAT(file.error().message, Not(HasSubstr("--")));
}

}  // namespace
}  // namespace vitrine
