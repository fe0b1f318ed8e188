// SPDX-License-Identifier: Apache-2.0
// The models of tests/golden: what they are made of, and what a golden file's text says of it.
#pragma once

#include <string>
#include <vector>

#include "support/stored_model.h"

namespace vitrine::test {

struct GoldenModel {
  std::string name;  // NAME.pmesh and NAME.levels
  LatticeMesh mesh;
  SimplifyOptions options;
};

std::vector<GoldenModel> golden_models();

// One line a level: its number, vertices, faces and the SHA-256 of its canonical surface, each
// number as 32 little-endian bits.
std::string level_digests(const Manifest& manifest, const BaseMesh& base,
                          std::span<const std::uint8_t> file);

}  // namespace vitrine::test
