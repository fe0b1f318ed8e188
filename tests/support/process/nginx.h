// SPDX-License-Identifier: Apache-2.0
// Runs the real nginx as a child process, for measurements against it and as a proxy in front of
// the daemon.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {

// An nginx with one worker on a free port of 127.0.0.1. The destructor ends it.
class Nginx {
 public:
  // `server` is the content of nginx's server block, and `http` the text before that block. Once
  // the constructor returns, nginx accepts connections or lets them wait. Throws if nginx cannot be
  // started.
  explicit Nginx(const std::string& server, const std::string& http = "");
  ~Nginx();
  Nginx(const Nginx&) = delete;
  Nginx& operator=(const Nginx&) = delete;

  std::uint16_t port() const { return port_; }
  pid_t pid() const { return child_; }
  // Returns the content of a log: "error.log", or one that `server` or `http` configures.
  std::string log(const std::string& name) const;

 private:
  TemporaryFolder folder_;
  std::uint16_t port_ = 0;
  pid_t child_ = -1;
};

}  // namespace vitrine::test
