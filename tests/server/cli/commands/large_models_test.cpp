// SPDX-License-Identifier: Apache-2.0
// Tests builds of models with many regions. Also tests the progress display and the files of a
// build that is stopped.
#include <gmock/gmock.h>

#include "support/on_terminal.h"
#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;

TEST_F(VitrineCommand, AModelWithRegionsIsVerifiedInSeveralOrders) {
  const std::string file = model(130'000);
  const json report = vitrine_json({"verify", file, "--against", path("model.ply")});
  EXPECT_EQ(report["lossless"], true);
  EXPECT_GT(vitrine_json({"info", file})["regions"], 1);
  EXPECT_GT(report["orders"], 1);
}

TEST_F(VitrineCommand, TheProgressBarIsRedrawnWithoutNewReports) {
  const std::string in = write("in.ply", bumpy_ply(130'000));
  OnTerminal build({kVitrine, "build", in, "--force", "-o", path("out.pmesh")});
  // Suspends the sandboxed child process in its first stage, which is long. The child then reports
  // no more progress.
  build.wait_for(" % read");
  build.signal_child(SIGSTOP);
  build.wait_for(" left", 3);
  build.signal_child(SIGCONT);
  EXPECT_EQ(build.finish(), 0);
}

TEST_F(VitrineCommand, AnInterruptedBuildLeavesNothingAndCanBeStartedAgain) {
  const std::string in = write("in.ply", bumpy_ply(130'000));
  for (const int number : {SIGINT, SIGTERM, SIGKILL}) {
    OnTerminal build({kVitrine, "build", in, "--force", "-o", path("out.pmesh")});
    build.wait_for(" % simplify");
    build.signal(number);
    const int status = build.finish();
    ASSERT_TRUE(WIFSIGNALED(status)) << build.seen();
    EXPECT_EQ(WTERMSIG(status), number);
    EXPECT_THAT(files(), ElementsAre("in.ply"));
  }
  vitrine_json({"build", in, "-o", path("out.pmesh")});
  EXPECT_EQ(vitrine_json({"verify", path("out.pmesh"), "--against", in})["lossless"], true);
}

TEST_F(VitrineCommand, AnInterruptedBuildLeavesAnOlderOutputAsItWas) {
  const std::string in = write("in.ply", bumpy_ply(130'000)), out = write("out.pmesh", "precious");
  OnTerminal build({kVitrine, "build", in, "--force", "-o", out});
  build.wait_for(" % encode");
  build.signal(SIGTERM);
  EXPECT_TRUE(WIFSIGNALED(build.finish()));
  EXPECT_EQ(read("out.pmesh"), "precious");
  EXPECT_THAT(files(), ElementsAre("in.ply", "out.pmesh"));
}

}  // namespace
}  // namespace vitrine::test
