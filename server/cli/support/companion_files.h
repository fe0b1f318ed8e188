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

// kBuffers opens only the buffers of a glTF model, which contain its shape.
enum class CompanionKinds : std::uint8_t { kAll, kBuffers };

// A mesh file, and the folder in which to search for its companions.
struct ModelPath {
  std::string file, folder;

  // Returns the path that the user gave, and the path's folder. If the path is a folder, chooses
  // the model in it and in its subfolders by choose_model(), and prints a note if there was a
  // choice. Fails (kBadInput) if the folder has no model or several models.
  static Expected<ModelPath> of(const std::string& path);
};

class CompanionFiles {
 public:
  // Searches the folder `path.folder` and its subfolders, except hidden files and folders. For a
  // glTF model, opens the files whose names occur as URIs in its JSON. For an FBX file, opens the
  // pictures that its records name. For other meshes, opens the .mtl files and the pictures whose
  // names occur in the first megabyte of `mesh` (in the first 16 of a DAE file), and the pictures
  // whose names occur in these .mtl files. Names may be percent-encoded. If several files have the
  // same name, opens all of them, because only the reader knows which file is meant. Opens no files
  // for a package, which contains its own files.
  CompanionFiles(const ModelPath& path, std::span<const std::uint8_t> mesh,
                 CompanionKinds kinds = CompanionKinds::kAll);
  // Searches the folder of the file `path`.
  CompanionFiles(const std::string& path, std::span<const std::uint8_t> mesh,
                 CompanionKinds kinds = CompanionKinds::kAll);

  // The result is valid while this object exists.
  Companions contents() const;

 private:
  std::map<std::string, InputFile> files_;  // key: companion_key()
};

}  // namespace vitrine::server::cli
