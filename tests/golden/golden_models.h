// SPDX-License-Identifier: Apache-2.0
// The models of tests/golden, and the text of the .levels files, which describe a model's levels.
#pragma once

#include <string>
#include <vector>

#include "support/product_names.h"
#include "support/stored_model.h"

namespace vitrine::test {

struct GoldenModel {
  std::string name;  // the files are named NAME.pmesh and NAME.levels
  LatticeMesh mesh;
  SimplifyOptions options;
  bool is_textured = false;  // whether the base mesh has a random atlas, with two small pictures
};

std::vector<GoldenModel> golden_models();

StoredModel stored(const GoldenModel& golden);

// Returns one line per level: the level's number, its numbers of vertices and faces, and the
// SHA-256 of its surface in canonical order. If the model has a texture, a second SHA-256 covers
// the positions and texture coordinates of the faces (face_set.h). Numbers are hashed as 32-bit
// little-endian integers. Returns an error message if the file is damaged.
std::string level_digests(std::span<const std::uint8_t> file);

}  // namespace vitrine::test
