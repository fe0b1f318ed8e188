// SPDX-License-Identifier: Apache-2.0
// Models of many regions, and what is seen and left of a build of one that is stopped.
#include <gmock/gmock.h>

#include "support/on_terminal.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;

TEST_F(VitrineCommand, a_model_with_regions_is_verified_in_several_orders) {
  const std::string file = model(130'000);
  const json report = vitrine_json({"verify", file, "--against", path("model.ply")});
  EXPECT_EQ(report["lossless"], true);
  EXPECT_GT(vitrine_json({"info", file})["regions"], 1);
  EXPECT_GT(report["orders"], 1);
}

TEST_F(VitrineCommand, the_bar_is_drawn_anew_while_a_build_has_nothing_to_report) {
  const std::string in = write("in.ply", bumpy_ply(130'000));
  OnTerminal build({kVitrine, "build", in, "-o", path("out.pmesh")});
  build.wait_for(" % read");  // the first bar, long before the next
  build.signal_child(SIGSTOP);
  build.wait_for(" left", 3);
  build.signal_child(SIGCONT);
  EXPECT_EQ(build.finish(), 0);
}

TEST_F(VitrineCommand, an_interrupted_build_leaves_nothing_and_can_be_started_again) {
  const std::string in = write("in.ply", bumpy_ply(130'000));
  for (const int number : {SIGINT, SIGTERM, SIGKILL}) {
    OnTerminal build({kVitrine, "build", in, "-o", path("out.pmesh")});
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

TEST_F(VitrineCommand, an_interrupted_build_leaves_an_older_output_as_it_was) {
  const std::string in = write("in.ply", bumpy_ply(130'000)), out = write("out.pmesh", "precious");
  OnTerminal build({kVitrine, "build", in, "-o", out});
  build.wait_for(" % encode");
  build.signal(SIGTERM);
  EXPECT_TRUE(WIFSIGNALED(build.finish()));
  EXPECT_EQ(read("out.pmesh"), "precious");
  EXPECT_THAT(files(), ElementsAre("in.ply", "out.pmesh"));
}

}  // namespace
}  // namespace vitrine::test
