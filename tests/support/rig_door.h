// SPDX-License-Identifier: Apache-2.0
// What somebody who stands beside the simulated rig says and sees (operator_door.h).
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

// The answer to one command, each with its line end; empty where none comes.
inline std::string said(const std::filesystem::path& socket, const std::string& command) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::strncpy(name.sun_path, socket.c_str(), sizeof name.sun_path - 1);
  const FileDescriptor door(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  std::string answer;
  if (::connect(door.get(), reinterpret_cast<sockaddr*>(&name), sizeof name) == 0 &&
      ::send(door.get(), command.data(), command.size(), MSG_NOSIGNAL) > 0) {
    for (char c = 0; !answer.ends_with('\n') && ::recv(door.get(), &c, 1, 0) == 1;)
      answer += c;
  }
  return answer;
}

struct RigLook {
  bool laser = false, motor = false;
  double degrees = 0;  // of the table
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
