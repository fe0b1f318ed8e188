// SPDX-License-Identifier: Apache-2.0
// Runs a program at a terminal, which the test types into and reads.
#pragma once

#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <string>
#include <vector>

namespace vitrine::test {

// Runs a program on a pseudo-terminal.
class OnTerminal {
 public:
  explicit OnTerminal(std::vector<std::string> words) {
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words)
      arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_ = ::forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (pid_ == 0) {
      ::execv(arguments[0], arguments.data());
      ::_exit(127);
    }
  }
  ~OnTerminal() { ::close(terminal_); }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  // Reads until `text` has occurred `times` times, or until the program's output ends.
  void wait_for(const std::string& text, int times = 1) {
    while (count(text) < times && read_some()) {
    }
  }
  void signal(int number) const { ::kill(pid_, number); }
  // Sends a signal to the child process, which does the work.
  void signal_child(int number) const {
    const std::string pid = std::to_string(pid_);
    std::ifstream children("/proc/" + pid + "/task/" + pid + "/children");
    pid_t child = 0;
    ASSERT_TRUE(children >> child);
    ::kill(child, number);
  }
  // Reads the rest of the output. Returns the program's status in the form of waitpid().
  int finish() {
    while (read_some()) {
    }
    int status = 0;
    ::waitpid(pid_, &status, 0);
    return status;
  }
  const std::string& seen() const { return seen_; }

 private:
  int count(const std::string& text) const {
    int found = 0;
    for (std::size_t at = 0; (at = seen_.find(text, at)) != std::string::npos; at += text.size())
      ++found;
    return found;
  }

  bool read_some() {
    std::array<char, 4096> part{};
    ssize_t n = 0;
    do {
      n = ::read(terminal_, part.data(), part.size());
    } while (n < 0 && errno == EINTR);
    if (n > 0) seen_.append(part.data(), static_cast<std::size_t>(n));
    return n > 0;
  }

  int terminal_ = -1;
  pid_t pid_ = -1;
  std::string seen_;
};

}  // namespace vitrine::test
