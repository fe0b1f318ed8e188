// SPDX-License-Identifier: Apache-2.0
// What an operator does by hand, asked of the simulated rig: to put the calibration target on the
// table and the object back. One line a command over its Unix socket, one line an answer.
#pragma once

#include <filesystem>
#include <string>

#include "codec/core/expected.h"
#include "codec/files/file_descriptor.h"

namespace vitrine {

class RigLink {
 public:
  // Fails (kIo) where no rig listens there.
  static Expected<RigLink> connect(const std::filesystem::path& socket);

  Expected<int> poses();  // of the target: held before the table, then standing on it
  Expected<void> place_target(int pose);
  Expected<void> place_object();

 private:
  explicit RigLink(FileDescriptor socket) : socket_(std::move(socket)) {}

  // The answer's line, without "ok"; "error: …" is an error.
  Expected<std::string> ask(std::string_view command);
  Expected<std::string> read_line();

  FileDescriptor socket_;
  std::string unread_;
};

}  // namespace vitrine
