// SPDX-License-Identifier: Apache-2.0
#include "support/process/daemon.h"
#include "support/product_names.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace vitrine::test {
namespace {

struct Child {
  pid_t id;
  int output;
};

Child start(const std::vector<std::string>& arguments, const std::string& terminal = "") {
  const std::string program = std::string(VITRINE_BIN_DIR) + "/vitrined";
  std::vector<char*> words = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments)
    words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  const pid_t id = ::fork();
  if (id == 0) {
    if (!terminal.empty()) {
      ::setsid();  // makes the terminal opened next the controlling terminal
      ::dup2(::open(terminal.c_str(), O_RDWR), STDIN_FILENO);
    }
    ::dup2(ends[1], STDOUT_FILENO);
    ::dup2(ends[1], STDERR_FILENO);
    ::execv(program.c_str(), words.data());
    ::_exit(127);
  }
  ::close(ends[1]);
  return {id, ends[0]};
}

int wait_for(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

bool read_some(int descriptor, std::string& text) {
  char buffer[4096];
  const ssize_t count = ::read(descriptor, buffer, sizeof buffer);
  if (count > 0) text.append(buffer, static_cast<std::size_t>(count));
  return count > 0;
}

// Whether a line of the daemon or of a sanitizer's runtime reports an error.
bool tells_of_an_error(const std::string& line) {
  for (const char* const sign : {"event=error", "terminate called", "ERROR: ", "runtime error: "})
    if (line.find(sign) != std::string::npos) return true;
  return false;
}

std::uint16_t port_in(const std::string& line) {
  if (line.find("unix:") != std::string::npos) return 0;
  return static_cast<std::uint16_t>(std::stoi(line.substr(line.rfind(':') + 1)));
}

}  // namespace

ProgramResult run_vitrined(const std::vector<std::string>& arguments) {
  const Child child = start(arguments);
  ProgramResult result;
  while (read_some(child.output, result.output)) {
  }
  ::close(child.output);
  result.exit_code = wait_for(child.id);
  return result;
}

Daemon::Daemon(const std::filesystem::path& data, std::vector<std::string> more,
               const std::string& terminal)
    : access_log_(data / "access.log") {
  std::vector<std::string> arguments = {
      "--data",      data.string(),  "--listen",           "127.0.0.1:0", "--admin-listen",
      "127.0.0.1:0", "--access-log", access_log_.string(), "--threads",   "2"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Child child = start(arguments, terminal);
  child_ = child.id;
  pipe_ = child.output;
  while (admin_port_ == 0) {  // the admin port is printed last
    const std::string line = read_line();
    if (line.find("listening on") == std::string::npos) continue;
    const bool is_admin = line.find("admin listening on") != std::string::npos;
    (is_admin ? admin_port_ : port_) = port_in(line);
  }
}

// Waits for the next line of the daemon's output and returns it.
std::string Daemon::read_line() {
  static constexpr const char* kEnded = "the daemon ended: ";
  std::size_t end;
  while ((end = printed_.find('\n', read_)) == std::string::npos) {
    if (!read_some(pipe_, printed_)) throw std::runtime_error(kEnded + printed_);
  }
  std::string line = printed_.substr(read_, end - read_);
  read_ = end + 1;
  return line;
}

std::string Daemon::wait_for_line(std::string_view text) {
  std::string line;
  do {
    line = read_line();
  } while (line.find(text) == std::string::npos);
  awaited_.push_back(line);
  return line;
}

void Daemon::check_log() const {
  std::istringstream lines(printed_);
  for (std::string line; std::getline(lines, line);) {
    if (tells_of_an_error(line) && std::ranges::find(awaited_, line) == awaited_.end())
      when_log_is_unclean(line);
  }
}

void Daemon::signal(int number) const {
  ::kill(child_, number);
}

ProgramResult Daemon::wait() {
  while (read_some(pipe_, printed_)) {
  }
  const int exit_code = wait_for(child_);
  child_ = -1;
  check_log();
  return {exit_code, printed_, {}};
}

std::string Daemon::access_log() const {
  std::ostringstream text;
  text << std::ifstream(access_log_).rdbuf();
  return text.str();
}

Daemon::~Daemon() {
  if (child_ > 0) {
    signal(SIGKILL);
    wait_for(child_);
    // Reading must not block, because children of the daemon may still hold the write end of the
    // pipe open.
    ::fcntl(pipe_, F_SETFL, O_NONBLOCK);
    while (read_some(pipe_, printed_)) {
    }
    check_log();
  }
  ::close(pipe_);
}

}  // namespace vitrine::test
