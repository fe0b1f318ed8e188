// SPDX-License-Identifier: Apache-2.0
// The real nginx as a child process: a peer to measure against, and the proxy that ours runs
// behind.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

#include "support/temporary_folder.h"

namespace vitrine::test {

// One worker on a free port of 127.0.0.1. Killed at the end of its scope.
class Nginx {
 public:
  // `server` is the inside of its server block, `http` what stands before that. Connections wait
  // for it from the constructor's return on. Throws where it cannot be started.
  explicit Nginx(const std::string& server, const std::string& http = "");
  ~Nginx();
  Nginx(const Nginx&) = delete;
  Nginx& operator=(const Nginx&) = delete;

  std::uint16_t port() const { return port_; }
  pid_t pid() const { return child_; }
  std::string log(const std::string& name) const;  // "error.log", or what the blocks write

 private:
  TemporaryFolder folder_;
  std::uint16_t port_ = 0;
  pid_t child_ = -1;
};

}  // namespace vitrine::test
