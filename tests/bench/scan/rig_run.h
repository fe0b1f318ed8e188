// SPDX-License-Identifier: Apache-2.0
// A whole scan by the programs that ship, at a rig of their own.
#pragma once

#include <filesystem>
#include <string>

#include "sections.h"
#include "truth.h"

namespace vitrine::bench {

// A folder that goes with the object.
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

// Within double quotes of a shell.
std::string program(const char* name);

// Runs a line of sh; throws where it fails.
void shell(const std::string& line);

// Runs `script`, a file of sh, at a rig of 80 mm of `object`; it finds "rig.json" in `folder`, and
// afterwards "truth.ply" is there. `options` are more words for vitrine-rig.
void at_rig(const RigFolder& folder, const Object& object, int steps, const std::string& script,
            const std::string& options = "");

}  // namespace vitrine::bench
