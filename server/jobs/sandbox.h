// SPDX-License-Identifier: Apache-2.0
// Work on bytes that may be hostile happens in a child process that can compute and answer, and
// nothing else: no file can be opened, no socket, no program or process started, and memory, time
// and the size of the answer are bounded. Whatever happens in there becomes a one-line Error here.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "server/jobs/spill.h"

namespace vitrine {

struct SandboxLimits {
  std::uint64_t memory_bytes = 4ull << 30;  // address space
  std::uint32_t cpu_seconds = 1'800;        // over all threads
  std::chrono::milliseconds wall = std::chrono::minutes(30);
  std::uint64_t answer_bytes = 4ull << 30;
  SpillOptions spill = {};  // what lies in its file does not count as memory
};

// `stage` says what is being done, `fraction` in [0, 1] how far that is.
using ProgressReport = std::function<void(std::string_view stage, double fraction)>;

// What runs in the child. The progress it reports arrives at the parent's ProgressReport.
using SandboxedTask = std::function<Expected<std::vector<std::uint8_t>>(const ProgressReport&)>;

// Takes the calling process's rights away, for good: resource limits, no new privileges, and a
// seccomp filter that lets through what computing and answering need. Call it before the first
// hostile byte is read; files and pipes that are open stay usable. kIo where the kernel refuses.
Expected<void> confine(const SandboxLimits& limits);

// Forks, confines the child, runs `task` in it and returns what it returns. The child sees the
// parent's memory as it is now. Only for single-threaded processes: a fork keeps other threads'
// locks locked. Errors: the task's own; kLimit where a limit stops
// it; kBadInput where it crashes or attempts what is forbidden; kIo where there is no process.
Expected<std::vector<std::uint8_t>> run_sandboxed(const SandboxLimits& limits,
                                                  const SandboxedTask& task,
                                                  const ProgressReport& progress = {});

}  // namespace vitrine
