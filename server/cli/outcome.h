// SPDX-License-Identifier: Apache-2.0
// How a command ends: 0 done, 1 failed with a reason, 2 wrong usage; kNobodyReads in silence.
#pragma once

#include <csignal>
#include <string>
#include <utility>

#include "codec/core/expected.h"

namespace vitrine::cli {

struct Fault {
  int exit_code;
  std::string message;  // one line
};

// Who read stdout has seen enough, as `head` has: the exit code that shells give for SIGPIPE.
inline constexpr int kNobodyReads = 128 + SIGPIPE;

using Outcome = tl::expected<void, Fault>;

inline tl::unexpected<Fault> failed(std::string message) {
  return tl::unexpected(Fault{1, std::move(message)});
}
inline tl::unexpected<Fault> failed(const Error& error) {
  return failed(error.message);
}
inline tl::unexpected<Fault> misused(std::string message) {
  return tl::unexpected(Fault{2, std::move(message)});
}

}  // namespace vitrine::cli
