// SPDX-License-Identifier: Apache-2.0
// Tests the progress display of a build on a terminal.
#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "server/cli/support/console.h"
#include "support/on_terminal.h"
#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;

// Returns all progress values that the terminal received, in order.
std::vector<int> shares_in(const std::string& seen) {
  static const std::regex share("([0-9]+) % ");
  std::vector<int> shares;
  for (auto at = std::sregex_iterator(seen.begin(), seen.end(), share);
       at != std::sregex_iterator(); ++at)
    shares.push_back(std::stoi((*at)[1]));
  return shares;
}

TEST(TimeLeft, IsEstimatedFromThePaceSoFar) {
  EXPECT_EQ(cli::time_left(10, 0.2, 0), "about 40 s left");
  EXPECT_EQ(cli::time_left(60, 0.1, 0), "about 9 min left");
  EXPECT_EQ(cli::time_left(3'600, 0.1, 0), "about 9 h left");
  EXPECT_EQ(cli::time_left(0.001, 0.5, 0), "about 1 s left");
}

TEST(TimeLeft, RunsDownButNotToZero) {
  EXPECT_EQ(cli::time_left(10, 0.2, 15), "about 25 s left");
  EXPECT_EQ(cli::time_left(10, 0.2, 1'000), "about 1 s left");
}

TEST(TimeLeft, IsEmptyAtTheStartAndAtTheEnd) {
  for (const double fraction : {-1.0, 0.0, 0.001, 1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(cli::time_left(10, fraction, 0), "") << fraction;
}

TEST_F(VitrineCommand, ATerminalShowsProgressAndTheTimeLeft) {
  const std::string in = write("in.ply", bumpy_ply(3'000));
  OnTerminal build({kVitrine, "build", in, "--force", "-o", path("out.pmesh")});
  EXPECT_EQ(build.finish(), 0);
  EXPECT_THAT(build.seen(), HasSubstr(" s left"));
  EXPECT_THAT(build.seen(), HasSubstr(" % simplify"));
  EXPECT_THAT(build.seen(), HasSubstr(" % encode"));
}

TEST_F(VitrineCommand, TheProgressBarOfABuildWithAReportNeverGoesBack) {
  const std::string in = write("in.ply", bumpy_ply(3'000));
  OnTerminal build(
      {kVitrine, "build", in, "--force", "-o", path("out.pmesh"), "--report", path("out.html")});
  EXPECT_EQ(build.finish(), 0);
  EXPECT_THAT(build.seen(), HasSubstr(" % report"));
  const std::vector<int> shares = shares_in(build.seen());
  EXPECT_TRUE(std::ranges::is_sorted(shares)) << build.seen();
}

}  // namespace
}  // namespace vitrine::test
