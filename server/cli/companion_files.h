// SPDX-License-Identifier: Apache-2.0
// The material libraries and pictures that lie beside a mesh file and that it names. They are
// opened here because nothing can be opened in the sandbox, and not parsed before they are in it.
#pragma once

#include <map>
#include <string>

#include "codec/import/companions.h"
#include "server/cli/input.h"

namespace vitrine::cli {

class CompanionFiles {
 public:
  // Opens the .mtl files in the folder of `path` whose names occur in the first megabyte of `mesh`,
  // and the .png, .jpg and .jpeg files whose names occur in it or in those.
  CompanionFiles(const std::string& path, std::span<const std::uint8_t> mesh);

  // Valid as long as this.
  Companions contents() const;

 private:
  std::map<std::string, InputFile> files_;  // by companion_key()
};

}  // namespace vitrine::cli
