// SPDX-License-Identifier: Apache-2.0
// Writes a rig.json for the simulated scanner. It has the same form as the rig.json of a real
// scanner, which `vitrine` reads.
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
