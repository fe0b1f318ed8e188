// SPDX-License-Identifier: Apache-2.0
// The pipe from a confined child to its parent. The child sends any number of progress messages,
// then one result or error.
#pragma once

#include <sys/types.h>

#include "server/sandbox/sandbox.h"

namespace vitrine::server {

// Called in the child. Confines the child, runs the task, sends the result over `fd` and ends the
// process.
[[noreturn]] void answer_and_exit(int fd, const SandboxLimits& limits,
                                  const SandboxedTask& task) noexcept;

// Called in the child while answer_and_exit() runs. Ends the process. The parent then gets the
// error kLimit, which states which memory limit was too low.
[[noreturn]] void exit_without_memory() noexcept;

// Called in the parent. Returns the result that child `pid` sends over `fd`. Kills the child if it
// exceeds the wall time or the size limit of the result. Always waits until the child has ended.
Expected<std::vector<std::uint8_t>> await_answer(pid_t pid, int fd, const SandboxLimits& limits,
                                                 const ProgressReport& progress);

}  // namespace vitrine::server
