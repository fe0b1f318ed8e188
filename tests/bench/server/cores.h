// SPDX-License-Identifier: Apache-2.0
// Assigns work to processor cores, and measures processor time.
#pragma once

#include <sched.h>
#include <sys/types.h>

namespace vitrine::bench {

inline constexpr int kServerCore = 0, kClientCore = 1;

// Restricts this thread to one core, and also the processes that it starts while this object
// exists. Throws if the core is not available.
class OnCore {
 public:
  explicit OnCore(int core);
  ~OnCore();
  OnCore(const OnCore&) = delete;
  OnCore& operator=(const OnCore&) = delete;

 private:
  cpu_set_t before_;
};

// Returns the processor time, in seconds, that a process and its children have used so far.
double processor_seconds(pid_t process);

}  // namespace vitrine::bench
