// SPDX-License-Identifier: Apache-2.0
// Acts as the operator of the simulated rig: sends commands to its socket (operator_socket.h).
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>

#include "codec/files/file_descriptor.h"

namespace vitrine::test {

// Sends a command that ends with a line feed. Returns the answer with its line feed, or an empty
// text if no answer arrives.
inline std::string said(const std::filesystem::path& socket, const std::string& command) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::strncpy(name.sun_path, socket.c_str(), sizeof name.sun_path - 1);
  const FileDescriptor connection(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  std::string answer;
  if (::connect(connection.get(), reinterpret_cast<sockaddr*>(&name), sizeof name) == 0 &&
      ::send(connection.get(), command.data(), command.size(), MSG_NOSIGNAL) > 0) {
    for (char c = 0; !answer.ends_with('\n') && ::recv(connection.get(), &c, 1, 0) == 1;)
      answer += c;
  }
  return answer;
}

struct RigLook {
  bool laser = false, motor = false;
  double degrees = 0;  // angle of the table
};

inline RigLook look_at_rig(const std::filesystem::path& socket) {
  std::istringstream answer(said(socket, "look\n"));
  std::string ok, laser, motor;
  RigLook look;
  if (!(answer >> ok >> laser >> motor >> look.degrees) || ok != "ok")
    throw std::runtime_error("the rig does not say how it looks: " + answer.str());
  look.laser = laser == "on";
  look.motor = motor == "on";
  return look;
}

}  // namespace vitrine::test
