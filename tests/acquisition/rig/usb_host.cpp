// SPDX-License-Identifier: Apache-2.0
// usb_host PROGRAM ARGUMENT…: runs a program that sees a simulated USB board. The program controls
// the board through UsbRig (usb_rig.h). UsbRig sends commands over an inherited socket and receives
// answers, one line each.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <thread>

#include "acquisition/rig_board/usb_board.h"

namespace {

using vitrine::acquisition::rig::UsbBoard;
using vitrine::acquisition::rig::UsbBoardSettings;
using vitrine::acquisition::rig::UsbTransport;

UsbBoardSettings settings_from(std::istream& words) {
  const std::map<std::string, UsbTransport> transports = {{"cdc", UsbTransport::kCdcAcm},
                                                          {"ftdi", UsbTransport::kFtdi},
                                                          {"ch34x", UsbTransport::kCh34x}};
  std::string dialect, transport;
  UsbBoardSettings settings;
  words >> dialect >> transport >> settings.firmware.degrees_per_second;
  settings.is_fabscan = dialect == "fabscan";
  settings.transport = transports.at(transport);
  if (settings.is_fabscan) settings.firmware.steps_per_turn = 3200;
  return settings;
}

std::string obey(vitrine::acquisition::rig::UsbBoard& board, const std::string& line) {
  std::istringstream words(line);
  std::string command;
  words >> command;
  if (command == "plug") {
    const auto plugged = board.plug(settings_from(words));
    return plugged ? "ok" : plugged.error().message;
  }
  if (command == "unplug") return board.unplug(), "ok";
  if (command == "stall") return board.stall(), "ok";
  if (command == "babble") return board.babble(line.substr(command.size() + 1) + "\r\n"), "ok";
  if (command == "table") return fmt::format("{:.6f}", board.table());
  if (command == "laser") return board.laser() ? "on" : "off";
  if (command == "motor") return board.motor() ? "on" : "off";
  return "error: unknown command " + command;
}

void serve(vitrine::acquisition::rig::UsbBoard& board, int socket) {
  std::string line;
  char byte = 0;
  while (::read(socket, &byte, 1) == 1) {
    if (byte != '\n') {
      line += byte;
      continue;
    }
    const std::string answer = obey(board, line) + '\n';
    line.clear();
    if (::write(socket, answer.data(), answer.size()) < 0) return;
  }
}

int run(char** words, const std::vector<std::string>& environment, int socket) {
  const pid_t child = ::fork();
  if (child == 0) {
    for (std::string variable : environment)
      ::putenv(::strdup(variable.c_str()));
    ::fcntl(socket, F_SETFD, 0);
    ::setenv("VITRINE_USB_RIG", std::to_string(socket).c_str(), 1);
    ::execvp(words[0], words);
    std::perror(words[0]);
    ::_exit(127);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  vitrine::acquisition::rig::enter_testbed(argv);
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return 1;
  vitrine::acquisition::rig::UsbBoard board({});
  std::thread server([&] { serve(board, ends[0]); });
  const int code = run(argv + 1, board.environment(), ends[1]);
  ::shutdown(ends[0], SHUT_RDWR);
  server.join();
  return code;
}
