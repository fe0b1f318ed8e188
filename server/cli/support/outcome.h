// SPDX-License-Identifier: Apache-2.0
// The result of a command. Its exit code is 0 for success, 1 for failure, 2 for wrong usage, or
// kNobodyReads if the reader of stdout has closed the pipe.
#pragma once

#include <csignal>
#include <string>
#include <utility>

#include "codec/core/expected.h"

namespace vitrine::server::cli {

struct Fault {
  int exit_code;
  std::string message;  // one line
};

// The exit code if the reader of stdout has closed the pipe, as `head` does. It equals the code
// that shells report for a process killed by SIGPIPE. No message is printed in this case.
inline constexpr int kNobodyReads = 128 + SIGPIPE;

using CommandOutcome = tl::expected<void, Fault>;

inline tl::unexpected<Fault> failed(std::string message) {
  return tl::unexpected(Fault{1, std::move(message)});
}
inline tl::unexpected<Fault> failed(const Error& error) {
  return failed(error.message);
}
inline tl::unexpected<Fault> misused(std::string message) {
  return tl::unexpected(Fault{2, std::move(message)});
}

}  // namespace vitrine::server::cli
