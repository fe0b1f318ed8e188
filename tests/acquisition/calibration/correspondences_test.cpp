// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/correspondences.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vitrine::acquisition {
namespace {

using testing::HasSubstr;

std::string message(std::string_view csv) {
  const auto points = read_correspondences(csv, "points.csv");
  return points ? "accepted" : points.error().message;
}

TEST(Correspondences, AreReadFromCsv) {
  const auto points = read_correspondences(
      "u,v,x,y,pose\r\n1.5,2,-3.25,4e1,0\r\n 10, 20 ,30,40,-7\n", "points.csv");
  ASSERT_TRUE(points) << points.error().message;
  ASSERT_EQ(points->size(), 2u);
  EXPECT_EQ((*points)[0].u, 1.5);
  EXPECT_EQ((*points)[0].v, 2);
  EXPECT_EQ((*points)[0].at.x, -3.25);
  EXPECT_EQ((*points)[0].at.y, 40);
  EXPECT_EQ((*points)[1].v, 20);
  EXPECT_EQ((*points)[1].pose, -7);
  EXPECT_EQ(message("u,v,x,y,pose"), "accepted");
}

TEST(Correspondences, FaultsAreNamedWithTheirLine) {
  const auto second = [](const std::string& line) {
    return message("u,v,x,y,pose\n1,2,3,4,0\n" + line + "\n1,2,3,4,0\n");
  };
  EXPECT_EQ(second("1,2,3,4,5"), "accepted");
  EXPECT_THAT(message(""), HasSubstr("points.csv, line 1: expected \"u,v,x,y,pose\""));
  EXPECT_THAT(message("1,2,3,4,0\n"), HasSubstr("line 1: expected"));
  for (const char* line : {"", "1,2,3,4", "1,2,3,4,", "1,2,3,4,5,6", "1,2,3,4,5.5", "1,,3,4,5",
                           "1,2,nan,4,5", "1,2,inf,4,5", "1,2,3,4x,5", "1,2,3,1e999,5"}) {
    EXPECT_THAT(second(line), HasSubstr("points.csv, line 3: expected four numbers")) << line;
  }
}

}  // namespace
}  // namespace vitrine::acquisition
