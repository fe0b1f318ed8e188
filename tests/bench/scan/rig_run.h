// SPDX-License-Identifier: Apache-2.0
// Runs a whole scan with the installed programs and a simulated rig in a process of its own.
#pragma once

#include <filesystem>
#include <string>

#include "sections.h"
#include "support/product_names.h"
#include "truth.h"

namespace vitrine::bench {

// A temporary folder, which the destructor removes.
class RigFolder {
 public:
  RigFolder();
  ~RigFolder();
  RigFolder(const RigFolder&) = delete;
  RigFolder& operator=(const RigFolder&) = delete;

  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

// Returns the path of the program `name` in double quotes, for the shell.
std::string program(const char* name);

// Runs a shell command line. Throws if its exit code is not 0.
void shell(const std::string& line);

// Runs the shell script `script` while a simulated rig holds `object`, scaled to a height of 80 mm.
// The script runs in `folder`, which contains the scanner's configuration, "rig.json". Also writes
// the ground truth to "truth.ply" in `folder`. `options` are further arguments of vitrine-rig.
void at_rig(const RigFolder& folder, const Object& object, int steps, const std::string& script,
            const std::string& options = "");

}  // namespace vitrine::bench
