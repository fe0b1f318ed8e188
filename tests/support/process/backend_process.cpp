// SPDX-License-Identifier: Apache-2.0
#include "support/process/backend_process.h"
#include "support/product_names.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

namespace vitrine::test {

BackendProcess::BackendProcess(const std::vector<std::string>& words) {
  int input[2], output[2];
  if (::pipe2(input, O_CLOEXEC) != 0 || ::pipe2(output, O_CLOEXEC) != 0)
    throw std::runtime_error("no pipe");
  std::vector<char*> arguments;
  for (const std::string& word : words)
    arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  child_ = ::fork();
  if (child_ == 0) {
    ::dup2(input[0], STDIN_FILENO);
    ::dup2(output[1], STDOUT_FILENO);
    ::execvp(arguments[0], arguments.data());
    ::_exit(127);
  }
  ::close(input[0]);
  ::close(output[1]);
  input_ = input[1];
  output_ = output[0];
  line_ = read_line();
  if (!line_.empty()) return;
  ::close(input_);
  ::close(output_);
  ::waitpid(child_, nullptr, 0);
  throw std::runtime_error(words.front() + " does not start; run deploy/setup test");
}

std::string BackendProcess::read_line() {
  std::string line;
  for (char c = 0; ::read(output_, &c, 1) == 1 && c != '\n';)
    line += c;
  return line;
}

void BackendProcess::ask(const std::string& command) {
  const std::string line = command + '\n';
  if (::write(input_, line.data(), line.size()) != static_cast<ssize_t>(line.size()) ||
      read_line().empty()) {
    throw std::runtime_error("the server's script has ended at '" + command + "'");
  }
}

BackendProcess::~BackendProcess() {
  ::close(input_);
  ::close(output_);
  ::waitpid(child_, nullptr, 0);
}

}  // namespace vitrine::test
