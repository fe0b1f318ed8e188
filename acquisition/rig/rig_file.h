// SPDX-License-Identifier: Apache-2.0
// Writes a rig.json for this simulated scanner. `vitrine` reads it in the same way as that of a
// real scanner.
#pragma once

#include <filesystem>
#include <string>

namespace vitrine::acquisition::rig {

struct BoardAddress {
  std::string dialect, vendor, product, serial;  // for example horus, 0x2341, 0x0043
};

struct RigFile {
  std::string name = "rig", camera_address;
  BoardAddress board;
  int steps = 720;
  std::filesystem::path calibrations;  // folder of the calibrations
  std::filesystem::path socket;        // the operator's socket (operator_socket.h)
};

std::string to_json(const RigFile& rig);

}  // namespace vitrine::acquisition::rig
