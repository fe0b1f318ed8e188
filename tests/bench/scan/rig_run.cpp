// SPDX-License-Identifier: Apache-2.0
#include "rig_run.h"
#include "support/product_names.h"

#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): mkdtemp and system are POSIX

#include <fstream>
#include <stdexcept>

namespace vitrine::bench {

namespace fs = std::filesystem;

RigFolder::RigFolder() {
  std::string path = (fs::temp_directory_path() / "bench-scan-XXXXXX").string();
  if (::mkdtemp(path.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
  path_ = path;
}

RigFolder::~RigFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string program(const char* name) {
  return std::string("\"" VITRINE_BIN_DIR "/") + name + "\"";
}

void shell(const std::string& line) {
  if (::system(line.c_str()) != 0) throw std::runtime_error("this failed: " + line);
}

void at_rig(const RigFolder& folder, const Object& object, int steps, const std::string& script,
            const std::string& options) {
  const std::string file = (folder / "at-rig.sh").string();
  std::ofstream(file) << "set -e\ncd \"$(dirname \"$0\")\"\n" << script;
  shell(program("vitrine-rig") + " --private-network --height-mm 80 --steps " +
        std::to_string(steps) + " --mesh \"" + object.file.string() + "\" --write-config \"" +
        (folder / "rig.json").string() + "\" --write-truth \"" + (folder / "truth.ply").string() +
        "\" " + options + " -- sh \"" + file + "\"");
}

}  // namespace vitrine::bench
