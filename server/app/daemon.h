// SPDX-License-Identifier: Apache-2.0
// The daemon from its arguments to its end.
#pragma once

#include <span>
#include <string_view>

namespace vitrine {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;
inline constexpr int kExitUsage = 2;

// Returns the exit code. Serves until SIGTERM or SIGINT: then it is not ready any more, accepts
// nobody, finishes what is under way, closes WebSockets with 1012, cuts what is left after
// stop-timeout. A second signal ends it at once.
int run_daemon(std::span<const std::string_view> arguments,
               std::span<const std::string_view> environment);

}  // namespace vitrine
