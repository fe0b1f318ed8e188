// SPDX-License-Identifier: Apache-2.0
// Opens the material libraries, buffers and pictures beside a mesh file that refers to them. The
// files are opened outside the sandbox, which cannot open files, but parsed only inside it.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "codec/files/companions.h"
#include "server/cli/support/input.h"

namespace vitrine::server::cli {

// kBuffers opens only the .bin files, which contain the shape of a glTF model.
enum class CompanionKinds : std::uint8_t { kAll, kBuffers };

class CompanionFiles {
 public:
  // Opens the .mtl files in the folder of `path` and its subfolders whose names occur in the first
  // megabyte of `mesh`, or in the JSON of a glTF file. Also opens the .bin files and pictures whose
  // names occur in the same places or in those .mtl files. If several files have the same name,
  // opens the one in the folder itself, or else the one in the first subfolder. Opens no files for
  // a package, which contains its own.
  CompanionFiles(const std::string& path, std::span<const std::uint8_t> mesh,
                 CompanionKinds kinds = CompanionKinds::kAll);

  // The result is valid while this object exists.
  Companions contents() const;

 private:
  std::map<std::string, InputFile> files_;  // key: companion_key() of the file's name
};

}  // namespace vitrine::server::cli
