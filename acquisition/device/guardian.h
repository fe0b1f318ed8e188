// SPDX-License-Identifier: Apache-2.0
// Starts a guardian process, which switches the board off if this process dies. The Horus and
// FabScan firmware have no watchdog, so nothing else would switch the board off after a SIGKILL.
#pragma once

#include <utility>

#include "acquisition/device/board.h"

namespace vitrine::acquisition {

// A running guardian process. The guardian waits at the other end of a socket and holds no other
// resource. If the socket closes without dismiss(), the guardian opens the board and switches it
// off. The socket closes when this process ends or this object is destroyed. The destructor does
// not wait for the guardian.
class Guardian {
 public:
  static Expected<Guardian> start(const BoardSelector& selector,
                                  const std::filesystem::path& program);

  Guardian(Guardian&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  Guardian& operator=(Guardian&&) = delete;
  ~Guardian();

  // Returns false if the guardian process has died.
  bool is_there() const;

  // Ends the guardian process without touching the board. Returns after the process has ended.
  void dismiss();

 private:
  explicit Guardian(int socket) : socket_(socket) {}

  int socket_ = -1;
};

// The main function of the guardian program, which waits on standard input. Returns the exit code.
int guard(int argc, char** argv);

}  // namespace vitrine::acquisition
