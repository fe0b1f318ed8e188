// SPDX-License-Identifier: Apache-2.0
// Which processor core runs what, and how long it did.
#pragma once

#include <sched.h>
#include <sys/types.h>

namespace vitrine::bench {

inline constexpr int kServerCore = 0, kClientCore = 1;

// Keeps this thread, and what it starts meanwhile, on one core. Throws where there is none.
class OnCore {
 public:
  explicit OnCore(int core);
  ~OnCore();
  OnCore(const OnCore&) = delete;
  OnCore& operator=(const OnCore&) = delete;

 private:
  cpu_set_t before_;
};

// Seconds of processor time that a process and its children have used so far.
double processor_seconds(pid_t process);

}  // namespace vitrine::bench
