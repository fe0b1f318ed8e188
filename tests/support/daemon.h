// SPDX-License-Identifier: Apache-2.0
// The real daemon as a child process.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "support/run_program.h"

namespace vitrine::test {

// Runs vitrined to its end; `output` holds standard output and standard error.
ProgramResult run_vitrined(const std::vector<std::string>& arguments);

// A daemon on free ports of 127.0.0.1 that serves `data`. Killed at the end of its scope.
class Daemon {
 public:
  // Returns once it listens; `terminal`, where there is one, is its input and controls it. Throws
  // with what it printed where it ends instead.
  explicit Daemon(const std::filesystem::path& data, std::vector<std::string> more = {},
                  const std::string& terminal = "");
  ~Daemon();
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  std::uint16_t port() const { return port_; }  // 0: a Unix socket, or it does not serve
  std::uint16_t admin_port() const { return admin_port_; }
  pid_t pid() const { return child_; }
  void signal(int number) const;
  std::string wait_for_line(std::string_view text);  // the next that it prints with `text` in it
  ProgramResult wait();                              // for its end; all that it printed
  std::string access_log() const;

  // Called at a daemon's end with each line that tells of an error and that nobody has waited for.
  static inline void (*when_log_is_unclean)(const std::string& line) = [](const std::string&) {};

 private:
  std::string read_line();
  void check_log() const;

  std::filesystem::path access_log_;
  pid_t child_ = -1;
  int pipe_ = -1;
  std::string printed_;
  std::size_t read_ = 0;  // how much of it read_line has returned
  std::vector<std::string> awaited_;
  std::uint16_t port_ = 0, admin_port_ = 0;
};

}  // namespace vitrine::test
