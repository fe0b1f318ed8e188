// SPDX-License-Identifier: Apache-2.0
// Where the operator's hands and eyes would be: commands that put things on the table and tell what
// it does, over a Unix socket.
// One line a command, one line an answer:
//   target N   the calibration target at pose N        ok
//   object     the object                              ok
//   poses      how many poses there are                ok HELD STANDING
//   look       laser and motor, the table's angle      ok on off 12.500
// Poses 0 to HELD - 1 are held in the air; the STANDING ones after them stand on the table and turn
// with it. Whatever else is said: "error: " and what to say instead.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "acquisition/rig/stage.h"
#include "codec/core/expected.h"

namespace vitrine::rig {

std::string obey(std::string_view command, Stage& stage);

// Listens from construction to destruction, to one after another.
class OperatorDoor {
 public:
  virtual ~OperatorDoor() = default;
};

// Fails (kIo) where the socket cannot be made; removes it at the end. `stage` outlives it.
Expected<std::unique_ptr<OperatorDoor>> open_door(const std::filesystem::path& socket,
                                                  Stage& stage);

}  // namespace vitrine::rig
