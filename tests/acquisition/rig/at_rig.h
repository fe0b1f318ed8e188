// SPDX-License-Identifier: Apache-2.0
// Runs vitrine with a simulated rig whose calibration is known.
#pragma once

#include <gmock/gmock.h>

#include "acquisition/calibration/calibration_store.h"
#include "server/cli/commands/vitrine_command.h"
#include "support/rig_calibration.h"

namespace vitrine::acquisition::rig::test {

class AtRig : public vitrine::test::VitrineCommand {
 protected:
  AtRig() {
    write("object.ply", vitrine::test::bumpy_ply(3'000));
    EXPECT_TRUE(CalibrationStore(path("calibrations")).add(perfect_calibration(1)));
  }

  // Runs the shell script `script` under vitrine-rig in the test's folder. The folder has a
  // rig.json that describes the scanner.
  vitrine::test::ProgramResult at_rig(const std::string& script, std::vector<std::string> options) {
    options.insert(options.begin(), {VITRINE_BIN_DIR "/vitrine-rig", "--private-network",
                                     "--write-config", path("rig.json")});
    options.insert(options.end(), {"--", "sh", "-c", "cd \"$0\" || exit; vitrine=\"$1\"; " + script,
                                   folder_.path().string(), vitrine::test::kVitrine});
    return vitrine::test::run_program(options);
  }
  vitrine::test::ProgramResult with_object(const std::string& script,
                                           std::vector<std::string> options = {}) {
    options.insert(options.begin(), {"--mesh", path("object.ply"), "--height-mm", "40"});
    return at_rig(script, options);
  }
};

}  // namespace vitrine::acquisition::rig::test
