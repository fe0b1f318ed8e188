// SPDX-License-Identifier: Apache-2.0
// A real server that a script of this folder starts from Debian's packages.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace vitrine::test {

// Runs `words`, whose first line of output tells what is to be known of it, for as long as this
// lives: the script ends, and its servers with it, when its standard input does.
class BackendProcess {
 public:
  // Throws with what the script printed where it ends before it has told a line.
  explicit BackendProcess(const std::vector<std::string>& words);
  ~BackendProcess();
  BackendProcess(const BackendProcess&) = delete;
  BackendProcess& operator=(const BackendProcess&) = delete;

  const std::string& line() const { return line_; }
  void ask(const std::string& command);  // returns once it has answered

 private:
  std::string read_line();

  pid_t child_ = -1;
  int input_ = -1, output_ = -1;
  std::string line_;
};

}  // namespace vitrine::test
