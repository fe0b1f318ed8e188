// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/run_command.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace vitrine::acquisition::rig {
namespace {

// Time that a leftover process has to end before it is killed.
constexpr timespec kGracePeriod{5, 0};

sigset_t held_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGCHLD})
    sigaddset(&set, signal);
  return set;
}

std::vector<char*> wrapped(const std::vector<std::string>& words) {
  std::vector<char*> arguments{const_cast<char*>("umockdev-wrapper")};
  for (const std::string& word : words)
    arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  return arguments;
}

// Replaces the forked child by the command. Must not allocate: at the fork, another thread may have
// held the allocator's lock.
[[noreturn]] void become(char* const* arguments) {
  const sigset_t set = held_signals();
  ::sigprocmask(SIG_UNBLOCK, &set, nullptr);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  ::execvp(arguments[0], arguments);
  ::dprintf(STDERR_FILENO, "vitrine-rig: no umockdev-wrapper; install the package umockdev\n");
  ::_exit(127);
}

int exit_code(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// Waits until `child` ends, and forwards received signals to it. Returns its exit code.
int attend(pid_t child) {
  const sigset_t set = held_signals();
  for (;;) {
    int status = 0;
    pid_t ended = 0;
    while ((ended = ::waitpid(-1, &status, WNOHANG)) > 0) {
      if (ended == child) return exit_code(status);
    }
    const int signal = ::sigwaitinfo(&set, nullptr);
    if (signal > 0 && signal != SIGCHLD) ::kill(child, signal);
  }
}

std::vector<pid_t> children() {
  std::ifstream in(fmt::format("/proc/self/task/{}/children", ::getpid()));
  std::vector<pid_t> found;
  for (pid_t child = 0; in >> child;)
    found.push_back(child);
  return found;
}

// Ends the processes that the command left behind. The kernel has made them children of this
// process.
void end_leftovers() {
  sigset_t ended;
  sigemptyset(&ended);
  sigaddset(&ended, SIGCHLD);
  int signal = SIGTERM;
  for (auto left = children(); !left.empty(); left = children()) {
    for (const pid_t child : left)
      ::kill(child, signal);
    if (::sigtimedwait(&ended, nullptr, &kGracePeriod) < 0 && errno == EAGAIN) signal = SIGKILL;
    while (::waitpid(-1, nullptr, WNOHANG) > 0) {
    }
  }
}

}  // namespace

void hold_signals() {
  const sigset_t set = held_signals();
  ::sigprocmask(SIG_BLOCK, &set, nullptr);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
}

Expected<int> run_command(const std::vector<std::string>& words) {
  const std::vector<char*> arguments = wrapped(words);
  const pid_t child = ::fork();
  if (child < 0) {
    return fail(ErrorCode::kIo, fmt::format("{}: cannot be started: {}; try again later", words[0],
                                            std::strerror(errno)));
  }
  if (child == 0) become(arguments.data());
  const int code = attend(child);
  end_leftovers();
  return code;
}

}  // namespace vitrine::acquisition::rig
