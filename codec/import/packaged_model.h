// SPDX-License-Identifier: Apache-2.0
// The model in a zip, tar or gzip package, with its material libraries, buffers and pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/files/companions.h"
#include "codec/package/unpack.h"

namespace vitrine::inline codec {

// The file that choose_model() has chosen from a list of files.
struct ChosenModel {
  std::size_t file;       // index of the file in the list of all files
  std::string note = {};  // says which file was chosen; empty if there was no choice
};

// Chooses the model among the files of a package or folder: the only file with an extension that
// formats.h lists. If several files are versions of the same model, chooses the most detailed one,
// according to the numbers in names such as "bust_lod0". Among equally detailed versions, chooses
// the format that stores most: GLB, glTF, OBJ, PLY, 3MF, OFF, STL, in this order. FBX and DAE files
// count only if there is no model in another format, because they are often the source of the
// model. Returns nullopt if there is no model. Fails (kBadInput) if there are several models, which
// the message names. `holder` is "package" or "folder", for messages.
Expected<std::optional<ChosenModel>> choose_model(std::span<const std::string> paths,
                                                  const std::string& holder);

class PackagedModel {
 public:
  // Unpacks a package and chooses its model by choose_model(). If that finds no model, takes the
  // only model part of a 3MF package. Fails (kBadInput) if the package has no model. Also fails
  // with the errors of choose_model() and unpack().
  static Expected<PackagedModel> open(std::span<const std::uint8_t> package);

  // Path in the package; empty for a gzip file.
  std::string_view name() const { return files_[model_].path; }
  std::span<const std::uint8_t> bytes() const { return files_[model_].bytes; }

  // The files of the package to which the model may refer. The result is valid while this object
  // exists.
  Companions beside() const;

  // Returns a note that says which file was chosen, or an empty string if there was no choice.
  const std::string& note() const { return note_; }

 private:
  explicit PackagedModel(std::vector<PackedFile> files) : files_(std::move(files)) {}

  // Whether the model may refer to the file with this path.
  bool is_companion(std::string_view path) const;
  // Unpacks the package again if the model names files that were not unpacked whole because of
  // their extension, such as glTF buffers with the extension ".data".
  Expected<PackagedModel> with_named_files(std::span<const std::uint8_t> package);

  std::vector<PackedFile> files_;
  std::set<std::string> named_;  // name_key() of the files that a glTF model states
  std::size_t model_ = 0;
  std::string note_;
};

}  // namespace vitrine::inline codec
