// SPDX-License-Identifier: Apache-2.0
#include "server/cli/report/rate_plot.h"

#include <gmock/gmock.h>

#include <regex>

namespace vitrine::server {
namespace {

using testing::HasSubstr;

struct Mark {
  double x, y;
};

// Returns the marks on the plotted line, without the marks of the legend.
std::vector<Mark> marks(const std::string& drawing) {
  static const std::regex kMark(R"re(<circle cx="([\d.]+)" cy="([\d.]+)" r="3.5"><title>)re");
  std::vector<Mark> out;
  for (std::sregex_iterator it(drawing.begin(), drawing.end(), kMark), end; it != end; ++it)
    out.push_back({std::stod((*it)[1]), std::stod((*it)[2])});
  return out;
}

TEST(RatePlot, EqualRatiosAreEqualDistances) {
  const auto at = marks(rate_plot({{"ours", "ours", {{100, 1}, {1'000, 0.1}, {10'000, 0.01}}}}));
  ASSERT_EQ(at.size(), 3u);
  EXPECT_GT(at[1].x, at[0].x + 100);
  EXPECT_GT(at[1].y, at[0].y + 50);  // y grows downwards
  EXPECT_NEAR(at[1].x - at[0].x, at[2].x - at[1].x, 0.2);
  EXPECT_NEAR(at[1].y - at[0].y, at[2].y - at[1].y, 0.2);
}

TEST(RatePlot, AllSeriesShareTheAxes) {
  const auto at = marks(rate_plot(
      {{"ours", "a", {{100, 1}, {900, 0.2}}}, {"peer", "b", {{100, 1}, {5'000, 0.001}}}}));
  ASSERT_EQ(at.size(), 4u);
  EXPECT_EQ(at[0].x, at[2].x);
  EXPECT_EQ(at[0].y, at[2].y);
}

TEST(RatePlot, APointWithoutErrorIsNotDrawn) {
  EXPECT_EQ(marks(rate_plot({{"ours", "a", {{100, 1}, {900, 0.2}, {2'000, 0}}}})).size(), 2u);
  EXPECT_EQ(rate_plot({{"ours", "a", {{2'000, 0}}}}), "");
  EXPECT_EQ(rate_plot({}), "");
}

TEST(RatePlot, EqualPointsStillGiveNumbers) {
  const std::string drawing = rate_plot({{"ours", "a", {{500, 0.1}, {500, 0.1}}}});
  EXPECT_EQ(marks(drawing).size(), 2u);
  EXPECT_EQ(drawing.find("nan"), std::string::npos);
  EXPECT_EQ(drawing.find("inf"), std::string::npos);
}

TEST(RatePlot, LabelsAreEscaped) {
  EXPECT_THAT(rate_plot({{"ours", "<a>", {{100, 1}, {900, 0.2}}}}), HasSubstr("&lt;a&gt;"));
}

}  // namespace
}  // namespace vitrine::server
