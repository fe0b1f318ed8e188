// SPDX-License-Identifier: Apache-2.0
// Tests each stripe method twice: in a scan with the simulated rig, and when the scan's pictures
// are processed again.
#include "at_rig.h"

namespace vitrine::acquisition::rig::test {
namespace {

using StripeMethods = AtRig;

TEST_F(StripeMethods, AScanReprocessedByAnotherOneIsTheScanByThatOne) {
  const std::string scan = "\"$vitrine\" scan --config rig.json --steps 32 ";
  const auto scanned = with_object(
      scan + "-o by_centre.ply --stripe centre-of-mass --keep-frames && " + scan + "-o usual.ply",
      {"--write-truth", path("truth.ply")});
  ASSERT_EQ(scanned.exit_code, 0) << scanned.errors;
  const auto reprocess = [&](const std::string& method) {
    const auto result =
        vitrine({"reprocess", path("by_centre.ply.scan"), "--config", path("rig.json"), "-o",
                 path(method + ".ply"), "--stripe", method});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return read(method + ".ply");
  };
  const std::string usual = read("usual.ply"), by_centre = read("by_centre.ply");
  EXPECT_TRUE(reprocess("derivative-of-gaussian") == usual);
  EXPECT_TRUE(reprocess("centre-of-mass") == by_centre);
  const std::string by_blais_rioux = reprocess("blais-rioux");
  EXPECT_FALSE(by_centre == usual || by_blais_rioux == usual || by_blais_rioux == by_centre);
  for (const char* mesh : {"usual.ply", "by_centre.ply", "blais-rioux.ply"}) {
    const auto distance = vitrine_json({"measure", path(mesh), path("truth.ply")});
    EXPECT_LT(distance["a_to_b"]["rms"].get<double>(), 0.3)
        << mesh;  // the limit is generous, because a scan with so few steps is coarse
  }
}

}  // namespace
}  // namespace vitrine::acquisition::rig::test
