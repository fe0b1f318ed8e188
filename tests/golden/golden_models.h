// SPDX-License-Identifier: Apache-2.0
// The models of tests/golden, and the text in a golden file that describes a model's levels.
#pragma once

#include <string>
#include <vector>

#include "support/product_names.h"
#include "support/stored_model.h"

namespace vitrine::test {

struct GoldenModel {
  std::string name;  // the files are NAME.pmesh and NAME.levels
  LatticeMesh mesh;
  SimplifyOptions options;
};

std::vector<GoldenModel> golden_models();

// Returns one line per level: the level's number, its counts of vertices and faces, and the SHA-256
// of its canonical surface, whose numbers are hashed as 32-bit little-endian integers. Returns an
// error message if a chunk is damaged.
std::string level_digests(const Manifest& manifest, const BaseMesh& base,
                          std::span<const std::uint8_t> file);

}  // namespace vitrine::test
