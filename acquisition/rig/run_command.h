// SPDX-License-Identifier: Apache-2.0
// Runs a command where the simulated USB board can be seen, and leaves nothing behind.
#pragma once

#include <string>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::rig {

// Keeps the signals that run_command() waits for from every thread; call it before there is a
// second one.
void hold_signals();

// Runs `words` under umockdev-wrapper and answers its exit code, 128 and the signal's number where
// one ended it. SIGTERM, SIGINT and SIGHUP are passed on to it. All that it started and left behind
// is ended, too, and it ends with this process.
Expected<int> run_command(const std::vector<std::string>& words);

}  // namespace vitrine::rig
