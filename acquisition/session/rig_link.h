// SPDX-License-Identifier: Apache-2.0
// Asks the simulated rig to act as the operator: to put the calibration target or the object on the
// table. Sends each command as one line over the rig's Unix socket and reads one line back.
#pragma once

#include <filesystem>
#include <string>

#include "codec/core/expected.h"
#include "codec/files/file_descriptor.h"

namespace vitrine::acquisition {

class RigLink {
 public:
  // Connects to the rig. Fails with kIo if no rig listens on that socket.
  static Expected<RigLink> connect(const std::filesystem::path& socket);

  // Returns the number of the target's poses. The poses held in front of the table come first, then
  // those standing on the table.
  Expected<int> poses();
  Expected<void> place_target(int pose);
  Expected<void> place_object();

 private:
  explicit RigLink(FileDescriptor socket) : socket_(std::move(socket)) {}

  // Sends a command and returns the answer without "ok". An answer "error: …" becomes an error.
  Expected<std::string> ask(std::string_view command);
  Expected<std::string> read_line();

  FileDescriptor socket_;
  std::string unread_;
};

}  // namespace vitrine::acquisition
