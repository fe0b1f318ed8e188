// SPDX-License-Identifier: Apache-2.0
// A process that outlives this one by the moment it takes to switch the board off: Horus and
// FabScan firmware know no watchdog, so after a SIGKILL nothing else would.
#pragma once

#include <sys/types.h>

#include <utility>

#include "acquisition/device/board.h"

namespace vitrine {

// The guardian waits at the end of a pipe and holds nothing else. Where the pipe ends without its
// having been dismissed, it opens the board and switches it off.
class Guardian {
 public:
  static Expected<Guardian> start(const BoardSelector& selector,
                                  const std::filesystem::path& program);

  Guardian(Guardian&& other) noexcept
      : pipe_(std::exchange(other.pipe_, -1)), process_(std::exchange(other.process_, -1)) {}
  Guardian& operator=(Guardian&&) = delete;
  ~Guardian() { dismiss(); }

  // It ends without touching the board.
  void dismiss();

 private:
  Guardian(int pipe, pid_t process) : pipe_(pipe), process_(process) {}

  int pipe_ = -1;
  pid_t process_ = -1;
};

// What the guardian's program does: waits on standard input; returns its exit code.
int guard(int argc, char** argv);

}  // namespace vitrine
