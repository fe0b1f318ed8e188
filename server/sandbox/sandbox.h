// SPDX-License-Identifier: Apache-2.0
// Processes hostile bytes in a child process that can only compute and send a result. The child
// cannot open files or sockets or start programs. Its memory, time and result are limited. If
// memory runs out, the kernel kills the child before its parent. The parent receives every failure
// of the child as a one-line Error.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/progress.h"
#include "server/sandbox/spill.h"

namespace vitrine::server {

struct SandboxLimits {
  // Largest size in bytes of the address space, and also of private memory. A lower limit that the
  // process inherits (LimitAS of systemd, ulimit -v) stays in force.
  std::uint64_t memory_bytes = 4ull << 30;
  std::uint32_t cpu_seconds = 1'800;  // sum over all threads
  std::chrono::milliseconds wall = std::chrono::minutes(30);
  std::uint64_t answer_bytes = 4ull << 30;
  SpillOptions spill = {};  // the spill file does not count as memory
};

// The task that runs in the child. The ProgressReport that it receives sends progress to the
// parent.
using SandboxedTask = std::function<Expected<std::vector<std::uint8_t>>(const ProgressReport&)>;

// Restricts the calling process permanently with resource limits, no new privileges, a network
// namespace of its own if the kernel allows it, and a seccomp filter. The filter only allows
// computing, reading and writing open files, and starting threads. Call this before reading the
// first hostile byte and before starting threads. Open files and pipes stay usable. Fails with kIo
// if the kernel refuses a limit or the filter.
Expected<void> confine(const SandboxLimits& limits);

// Forks, confines the child, runs `task` in the child and returns its result. The child has a copy
// of the parent's memory. The parent must be single-threaded, because locks held by other threads
// would stay locked in the child. Fails with the errors of the task, with kLimit if the child
// exceeds a limit, with kBadInput if it crashes or makes a forbidden system call, and with kIo if
// no process can be started.
Expected<std::vector<std::uint8_t>> run_sandboxed(const SandboxLimits& limits,
                                                  const SandboxedTask& task,
                                                  const ProgressReport& progress = {});

}  // namespace vitrine::server
