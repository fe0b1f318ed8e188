// SPDX-License-Identifier: Apache-2.0
// A real server from Debian's packages, which a script in this folder starts.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace vitrine::test {

// Runs the script `words`. The first line that the script prints is the server's address or port.
// The destructor closes the script's standard input. The script then stops its servers and ends.
class BackendProcess {
 public:
  // Throws with the script's output if the script ends before it prints a line.
  explicit BackendProcess(const std::vector<std::string>& words);
  ~BackendProcess();
  BackendProcess(const BackendProcess&) = delete;
  BackendProcess& operator=(const BackendProcess&) = delete;

  const std::string& line() const { return line_; }
  void ask(const std::string& command);  // sends a command and waits for the reply

 private:
  std::string read_line();

  pid_t child_ = -1;
  int input_ = -1, output_ = -1;
  std::string line_;
};

}  // namespace vitrine::test
