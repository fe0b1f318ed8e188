// SPDX-License-Identifier: Apache-2.0
// The pipe from a confined child to its parent: any number of progress messages, then one result
// or error.
#pragma once

#include <sys/types.h>

#include "server/jobs/sandbox.h"

namespace vitrine {

// In the child: confines it, runs the task, sends what it returns over `fd` and ends the process.
[[noreturn]] void answer_and_exit(int fd, const SandboxLimits& limits,
                                  const SandboxedTask& task) noexcept;

// In the parent: what child `pid` answers over `fd`. Ends the child where it exceeds the wall time
// or the answer's size, and always waits for it.
Expected<std::vector<std::uint8_t>> await_answer(pid_t pid, int fd, const SandboxLimits& limits,
                                                 const ProgressReport& progress);

}  // namespace vitrine
