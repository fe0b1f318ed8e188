// SPDX-License-Identifier: Apache-2.0
// serve_firmware PATH: serves a Horus board's firmware over a terminal or a Unix socket until the
// client hangs up. Prints each change of laser, motor and table on one line.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>

#include "acquisition/rig_board/firmware.h"

namespace {

using vitrine::acquisition::rig::Firmware;

int connect_to(const std::string& path) {
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  const int line = ::socket(AF_UNIX, SOCK_STREAM, 0);
  const auto* plain = reinterpret_cast<const sockaddr*>(&address);
  return ::connect(line, plain, sizeof address) == 0 ? line : -1;
}

int open_terminal(const std::string& path) {
  const int line = ::open(path.c_str(), O_RDWR | O_NOCTTY);
  termios mode{};
  if (::tcgetattr(line, &mode) != 0) return -1;
  ::cfmakeraw(&mode);
  return ::tcsetattr(line, TCSANOW, &mode) == 0 ? line : -1;
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class Report {
 public:
  explicit Report(std::string name) : name_(std::move(name)) {}

  void changes_of(const Firmware& firmware) {
    say(laser_, firmware.laser() ? "laser on" : "laser off");
    say(motor_, firmware.motor() ? "motor on" : "motor off");
    say(table_, fmt::format("table at {:.3f}", firmware.table(now())));
  }

 private:
  void say(std::string& last, const std::string& state) {
    if (last == state) return;
    last = state;
    fmt::print("{}: {}\n", name_, state);
    std::fflush(stdout);
  }
  std::string name_, laser_, motor_, table_;
};

bool send(int line, const std::string& bytes) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t count = ::write(line, bytes.data() + sent, bytes.size() - sent);
    if (count <= 0) return false;
    sent += static_cast<std::size_t>(count);
  }
  return true;
}

void serve(int line, Firmware& firmware, Report& report) {
  firmware.restart(now());
  std::array<char, 512> bytes{};
  do {
    report.changes_of(firmware);
    const ssize_t count = ::read(line, bytes.data(), bytes.size());
    if (count <= 0) return;
    firmware.receive({bytes.data(), static_cast<std::size_t>(count)}, now());
  } while (send(line, firmware.take_output()));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::string path = argv[1];
  const int line = std::filesystem::is_socket(path) ? connect_to(path) : open_terminal(path);
  if (line < 0) {
    fmt::print(stderr, "{}: {}\n", path, std::strerror(errno));
    return 1;
  }
  const auto firmware = vitrine::acquisition::rig::horus_firmware({});
  Report report(path);
  serve(line, *firmware, report);
  fmt::print("{}: hung up\n", path);
  return 0;
}
