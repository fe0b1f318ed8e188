// SPDX-License-Identifier: Apache-2.0
// The page itself: everything in it, nothing fetched, no script.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codec/render/picture.h"
#include "server/jobs/build_model.h"
#include "server/report/single_files.h"

namespace vitrine {

struct LevelPicture {
  std::uint32_t level = 0;
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> png;
};

struct PageContents {
  std::string name;  // of the input; any bytes
  std::uint64_t input_bytes = 0;
  Vec3 size;  // of the input's bounding box, model units
  BuildReport::Input input;
  Manifest manifest;                     // as the file has it
  Sha256 sha256;                         // of the .pmesh
  std::vector<LevelPicture> pictures;    // of rising levels
  std::vector<SingleFile> single_files;  // to compare with
};

// HTML that is well-formed XML too; the same contents give the same bytes.
std::string write_page(const PageContents& contents);

}  // namespace vitrine
