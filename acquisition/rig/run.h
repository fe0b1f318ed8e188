// SPDX-License-Identifier: Apache-2.0
// vitrine-rig from its command line to its exit code.
#pragma once

#include <span>
#include <string_view>

namespace vitrine::rig {

// The command's exit code; 1 where the rig cannot be started, 2 for wrong usage, both with one line
// on stderr.
int run(std::span<const std::string_view> words);

}  // namespace vitrine::rig
