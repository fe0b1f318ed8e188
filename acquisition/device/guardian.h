// SPDX-License-Identifier: Apache-2.0
// A process that outlives this one by the moment it takes to switch the board off: Horus and
// FabScan firmware know no watchdog, so after a SIGKILL nothing else would.
#pragma once

#include <utility>

#include "acquisition/device/board.h"

namespace vitrine {

// The guardian waits at the end of a socket and holds nothing else. Where the socket is closed
// without its having been dismissed, by the end of this process or of this object, it opens the
// board and switches it off; nobody waits for that.
class Guardian {
 public:
  static Expected<Guardian> start(const BoardSelector& selector,
                                  const std::filesystem::path& program);

  Guardian(Guardian&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  Guardian& operator=(Guardian&&) = delete;
  ~Guardian();

  // Not where it has died.
  bool is_there() const;

  // It ends without touching the board, before this returns.
  void dismiss();

 private:
  explicit Guardian(int socket) : socket_(socket) {}

  int socket_ = -1;
};

// What the guardian's program does: waits on standard input; returns its exit code.
int guard(int argc, char** argv);

}  // namespace vitrine
