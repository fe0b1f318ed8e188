// SPDX-License-Identifier: Apache-2.0
// What `vitrine` is told about this rig, as about any scanner: nothing of what calibration finds.
#pragma once

#include <filesystem>
#include <string>

namespace vitrine::rig {

struct BoardAddress {
  std::string dialect, vendor, product, serial;  // such as horus, 0x2341, 0x0043
};

struct RigFile {
  std::string name = "rig", camera_address;
  BoardAddress board;
  int steps = 720;
  std::filesystem::path calibrations;  // folder
  std::filesystem::path socket;        // of the operator's door
};

std::string to_json(const RigFile& rig);

}  // namespace vitrine::rig
