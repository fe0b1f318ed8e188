// SPDX-License-Identifier: Apache-2.0
#include "at_rig.h"

namespace vitrine::acquisition::rig::test {
namespace {

using KeptTable = AtRig;

// The scan's first motion takes 45 seconds, so the rig is certainly killed during that motion.
TEST_F(KeptTable, KeepsTheEndOfAMotionDuringWhichTheRigIsKilled) {
  const auto result = with_object(
      "trap '' TERM; \"$vitrine\" scan --config rig.json --steps 8 -o out.ply > scan.log 2>&1 & "
      "scan=$!; until [ -e table ]; do kill -0 $scan || exit; sleep 0.02; done; "
      "kill -KILL $PPID; kill -KILL $scan",
      {"--table", path("table"), "--degrees-per-second", "1"});
  EXPECT_EQ(read("table"), "45\n") << result.errors << read("scan.log");
}

}  // namespace
}  // namespace vitrine::acquisition::rig::test
