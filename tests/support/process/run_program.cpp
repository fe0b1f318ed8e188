// SPDX-License-Identifier: Apache-2.0
#include "support/process/run_program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

std::string contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void redirect(int from, const std::filesystem::path& to) {
  const int fd = ::open(to.c_str(), O_RDWR | O_CREAT, 0600);
  if (fd < 0 || ::dup2(fd, from) < 0) ::_exit(126);
}

}  // namespace

ProgramResult run_program(const std::vector<std::string>& words) {
  const TemporaryFolder folder;
  const auto output = folder.path() / "output", errors = folder.path() / "errors";
  std::vector<char*> arguments;
  for (const std::string& word : words)
    arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    redirect(STDIN_FILENO, "/dev/null");
    redirect(STDOUT_FILENO, output);
    redirect(STDERR_FILENO, errors);
    ::execvp(arguments[0], arguments.data());
    ::_exit(127);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(output), contents(errors)};
}

}  // namespace vitrine::test
