// SPDX-License-Identifier: Apache-2.0
// Lets a program act as the operator of the simulated rig, over a Unix socket. Commands put the
// target or the object on the table, or ask for the table's state. Each command and each answer is
// one line:
//   target N   puts the calibration target at pose N     ok
//   object     puts the object on the table              ok
//   poses      returns the number of poses               ok HELD STANDING
//   look       returns laser, motor and table angle      ok on off 12.500
// Poses 0 to HELD - 1 are held in the air. The STANDING poses after them stand on the table and
// turn with it. The answer to any other line is "error: " with the valid commands.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "acquisition/rig_optics/stage.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition::rig {

std::string obey(std::string_view command, Stage& stage);

// Listens until destroyed, and serves one client at a time.
class OperatorSocket {
 public:
  virtual ~OperatorSocket() = default;
};

// Creates the socket; destroying the result removes it. Fails with kIo if the socket cannot be
// created. `stage` must outlive the result.
Expected<std::unique_ptr<OperatorSocket>> open_operator_socket(const std::filesystem::path& socket,
                                                               Stage& stage);

}  // namespace vitrine::acquisition::rig
