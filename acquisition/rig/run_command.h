// SPDX-License-Identifier: Apache-2.0
// Runs a command that can see the simulated USB board, and cleans up after it.
#pragma once

#include <string>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::acquisition::rig {

// Blocks, in every thread, the signals that run_command() waits for. Call it before a second thread
// exists.
void hold_signals();

// Runs `words` under umockdev-wrapper. Returns the command's exit code, or 128 plus the signal's
// number if a signal ended the command. Forwards SIGTERM, SIGINT and SIGHUP to the command. Ends
// all processes that the command leaves behind, and ends the command if this process ends.
Expected<int> run_command(const std::vector<std::string>& words);

}  // namespace vitrine::acquisition::rig
