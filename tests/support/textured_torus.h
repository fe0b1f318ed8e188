// SPDX-License-Identifier: Apache-2.0
// A torus with a picture, for tests of textured models.
#pragma once

#include "codec/picture/write_picture.h"
#include "codec/repair/imported_mesh.h"
#include "support/meshes.h"

namespace vitrine::test {

// Returns a torus of 2 * `around` * `across` faces. The left half of its picture is red and belongs
// to the first half of the way around the torus. The right half is green.
inline ImportedMesh textured_torus(std::uint32_t around, std::uint32_t across) {
  ImportedMesh out{.mesh = torus(around, across)};
  constexpr std::uint32_t kSide = 64;
  Picture picture{kSide, kSide, {}};
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const bool is_left = i % kSide < kSide / 2;
    for (const int value : {is_left ? 255 : 0, is_left ? 0 : 255, 0, 255})
      picture.pixels.push_back(static_cast<std::uint8_t>(value));
  }
  Texturing& texturing = out.texturing;
  texturing.pictures = {{"halves.png", *write_png(picture)}};
  texturing.materials.resize(1);
  texturing.materials[0].base_colour_map.emplace();
  texturing.face_materials.assign(out.mesh.faces.size(), 0);
  for (std::size_t f = 0; f < out.mesh.faces.size(); ++f) {
    // grid_faces() makes two faces of each quad, from its lower left corner.
    const auto i = static_cast<float>(f / 2 % around), j = static_cast<float>(f / 2 / around);
    const auto at = [&](float right, float up) -> TextureCoordinates {
      return {(i + right) / static_cast<float>(around), (j + up) / static_cast<float>(across)};
    };
    texturing.coordinates[0].push_back(f % 2 == 0 ? std::array{at(0, 0), at(1, 0), at(1, 1)}
                                                  : std::array{at(0, 0), at(1, 1), at(0, 1)});
  }
  return out;
}

}  // namespace vitrine::test
