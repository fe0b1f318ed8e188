// SPDX-License-Identifier: Apache-2.0
// Opens the material libraries and pictures beside a mesh file that refers to them. The sandbox
// cannot open files, so they are opened outside it. They are parsed only in the sandbox.
#pragma once

#include <map>
#include <string>

#include "codec/import/companions.h"
#include "server/cli/support/input.h"

namespace vitrine::server::cli {

class CompanionFiles {
 public:
  // Opens the .mtl files in the folder of `path` whose names occur in the first megabyte of `mesh`,
  // and the .png, .jpg and .jpeg files whose names occur there or in those .mtl files.
  CompanionFiles(const std::string& path, std::span<const std::uint8_t> mesh);

  // The result is valid while this object exists.
  Companions contents() const;

 private:
  std::map<std::string, InputFile> files_;  // keys are results of companion_key()
};

}  // namespace vitrine::server::cli
