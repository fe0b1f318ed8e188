// SPDX-License-Identifier: Apache-2.0
// Writes the report page: self-contained HTML without scripts or requests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codec/build/build_model.h"
#include "codec/picture/picture.h"
#include "server/cli/report/single_files.h"

namespace vitrine::server {

struct LevelPicture {
  std::uint32_t level = 0;
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> png;
};

struct PageContents {
  std::string name;  // name of the input; may contain any bytes
  std::uint64_t input_bytes = 0;
  Vec3 size;  // size of the input's bounding box, in model units
  BuildReport::Input input;
  Manifest manifest;                     // the header of the .pmesh file
  Sha256 sha256;                         // SHA-256 of the .pmesh file
  std::vector<LevelPicture> pictures;    // in order from coarse to fine
  std::vector<SingleFile> single_files;  // files of single levels of detail, for comparison
};

// Returns HTML that is also well-formed XML. Equal contents give equal bytes.
std::string write_page(const PageContents& contents);

}  // namespace vitrine::server
