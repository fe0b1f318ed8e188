// SPDX-License-Identifier: Apache-2.0
// Runs vitrine-rig, from its command line to its exit code.
#pragma once

#include <span>
#include <string_view>

namespace vitrine::acquisition::rig {

// Runs the rig and returns the exit code: that of the command, 1 if the rig cannot be started, or 2
// for wrong usage. In the last two cases one line on stderr gives the reason.
int run(std::span<const std::string_view> words);

}  // namespace vitrine::acquisition::rig
