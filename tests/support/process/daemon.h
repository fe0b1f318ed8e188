// SPDX-License-Identifier: Apache-2.0
// Runs the real daemon as a child process.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "support/process/run_program.h"
#include "support/product_names.h"

namespace vitrine::test {

// Runs vitrined until it ends. The `output` of the result contains standard output and standard
// error.
ProgramResult run_vitrined(const std::vector<std::string>& arguments);

// A daemon that serves the folder `data` on free ports of 127.0.0.1. The destructor kills it.
class Daemon {
 public:
  // Returns once the daemon listens. If `terminal` is given, it is the daemon's standard input and
  // controlling terminal. Throws with the daemon's output if the daemon ends instead.
  explicit Daemon(const std::filesystem::path& data, std::vector<std::string> more = {},
                  const std::string& terminal = "");
  ~Daemon();
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  // Returns the port of the API; 0 if the daemon listens on a Unix socket.
  std::uint16_t port() const { return port_; }
  std::uint16_t admin_port() const { return admin_port_; }
  pid_t pid() const { return child_; }
  void signal(int number) const;
  std::string wait_for_line(std::string_view text);  // returns the next line that contains `text`
  ProgramResult wait();  // waits until the daemon ends; returns all its output
  std::string access_log() const;

  // Called when a daemon ends, once for each error line that no test has waited for.
  static inline void (*when_log_is_unclean)(const std::string& line) = [](const std::string&) {};

 private:
  std::string read_line();
  void check_log() const;

  std::filesystem::path access_log_;
  pid_t child_ = -1;
  int pipe_ = -1;
  std::string printed_;
  std::size_t read_ = 0;  // length of the part that read_line() has returned
  std::vector<std::string> awaited_;
  std::uint16_t port_ = 0, admin_port_ = 0;
};

}  // namespace vitrine::test
