// SPDX-License-Identifier: Apache-2.0
// Declares the entry point of the daemon.
#pragma once

#include <span>
#include <string_view>

namespace vitrine::server {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;
inline constexpr int kExitUsage = 2;

// Serves until SIGTERM or SIGINT and returns the exit code. To stop, the daemon reports that it is
// not ready, accepts no more connections, finishes open transfers, and closes WebSockets with code
// 1012. After stop-timeout, it closes the remaining connections. A second signal ends the daemon at
// once.
int run_daemon(std::span<const std::string_view> arguments,
               std::span<const std::string_view> environment);

}  // namespace vitrine::server
