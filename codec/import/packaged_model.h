// SPDX-License-Identifier: Apache-2.0
// The model in a zip, tar or gzip package, with its material libraries, buffers and pictures.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/files/companions.h"
#include "codec/package/unpack.h"

namespace vitrine::inline codec {

class PackagedModel {
 public:
  // Unpacks a package and chooses its model: the only file with an extension of formats.h. If
  // several files are versions of the same model, chooses the most detailed one, according to the
  // numbers in names such as "bust_lod0". Among equally detailed versions, chooses the format that
  // stores most: GLB, glTF, OBJ, PLY, 3MF, OFF, STL, in this order. Fails (kBadInput) if the
  // package has no model or several models, which the message then names. Also fails with the
  // errors of unpack().
  static Expected<PackagedModel> open(std::span<const std::uint8_t> package);

  // Path in the package; empty for a gzip file.
  std::string_view name() const { return files_[model_].path; }
  std::span<const std::uint8_t> bytes() const { return files_[model_].bytes; }

  // The other files of the package. If several have the same name, the result contains the one that
  // is nearest to the model: in its folder, in a subfolder, in the folder above, and so on. The
  // result is valid while this object exists.
  Companions beside() const;

  // Returns a note that says which file was chosen, or an empty string if there was no choice.
  const std::string& note() const { return note_; }

 private:
  explicit PackagedModel(std::vector<PackedFile> files) : files_(std::move(files)) {}

  std::vector<PackedFile> files_;
  std::size_t model_ = 0;
  std::string note_;
};

}  // namespace vitrine::inline codec
