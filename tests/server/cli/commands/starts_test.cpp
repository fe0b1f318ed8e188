// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/starts.h"

#include <gmock/gmock.h>

namespace vitrine::server::cli {
namespace {

using testing::HasSubstr;

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_LT(length(a - b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

TEST(Starts, AMotionTurnsCounterClockwiseAndThenShifts) {
  const auto starts = parse_starts(R"({"starts": [
      {"axis": {"z": 5}, "degrees": 90, "shift": {"x": 10, "z": -1}},
      {"axis": {"x": 1, "y": 1, "z": 1}, "degrees": 120}, {}]})",
                                   "s.json");
  ASSERT_TRUE(starts) << starts.error().message;
  ASSERT_EQ(starts->size(), 4u);
  expect_near((*starts)[0]({1, 2, 3}), {1, 2, 3});
  expect_near((*starts)[1]({1, 0, 0}), {10, 1, -1});
  expect_near((*starts)[1]({0, 1, 2}), {9, 0, 1});
  expect_near((*starts)[2]({1, 2, 3}), {3, 1, 2});
  expect_near((*starts)[3]({1, 2, 3}), {1, 2, 3});
}

TEST(Starts, AFaultNamesFileStartAndKey) {
  const auto fault = [](std::string_view text) {
    const auto starts = parse_starts(text, "s.json");
    return starts ? "" : starts.error().message;
  };
  EXPECT_THAT(fault("[]"), HasSubstr("s.json is not a JSON object"));
  EXPECT_THAT(fault("{}"), HasSubstr("s.json: \"starts\" must be an array"));
  EXPECT_THAT(fault(R"({"starts": [1]})"), HasSubstr("\"starts\" must be an array of objects"));
  EXPECT_THAT(fault(R"({"starts": [], "unit": "mm"})"), HasSubstr("\"unit\" is an unknown key"));
  EXPECT_THAT(fault(R"({"starts": [{}, {"degrees": 180}]})"),
              HasSubstr("s.json: start 2: \"axis\" must be the axis"));
  EXPECT_THAT(fault(R"({"starts": [{"shift": {"x": "far"}}]})"),
              HasSubstr("start 1: shift: \"x\" must be a number"));
}

}  // namespace
}  // namespace vitrine::server::cli
