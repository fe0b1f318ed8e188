// SPDX-License-Identifier: Apache-2.0
// Makes a mesh with a picture, as a mesh reader would return it.
#pragma once

#include <cmath>
#include <cstdint>

#include "codec/picture/write_picture.h"
#include "codec/repair/imported_mesh.h"
#include "support/meshes.h"

namespace vitrine::test {

// Returns a torus of `around` times `across` quads, with one picture of `side` x `side` pixels. The
// picture has smooth colours and is opaque.
inline ImportedMesh textured_torus(std::uint32_t around, std::uint32_t across, std::uint32_t side) {
  Picture picture{side, side, {}};
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const auto wave = static_cast<std::uint8_t>(128 + 100 * std::sin(0.1 * x + 0.07 * y));
      for (const auto value : {wave, static_cast<std::uint8_t>(255 * x / side),
                               static_cast<std::uint8_t>(255 * y / side), std::uint8_t{255}})
        picture.pixels.push_back(value);
    }
  }
  ImportedMesh out{.mesh = torus(around, across), .unit = "mm", .repairs = {}, .texturing = {}};
  out.texturing.pictures = {{"picture.png", write_png(picture).value()}};
  out.texturing.materials = {{.name = "clay", .base_colour_map = TextureMap{}}};
  out.texturing.face_materials.assign(out.mesh.faces.size(), 0);
  // grid_faces() makes two faces for each quad, row by row.
  for (std::uint32_t j = 0; j < across; ++j) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const auto at = [&](std::uint32_t right, std::uint32_t up) -> TextureCoordinates {
        return {static_cast<float>(i + right) / static_cast<float>(around),
                static_cast<float>(j + up) / static_cast<float>(across)};
      };
      out.texturing.coordinates[0].push_back({at(0, 0), at(1, 0), at(1, 1)});
      out.texturing.coordinates[0].push_back({at(0, 0), at(1, 1), at(0, 1)});
    }
  }
  return out;
}

}  // namespace vitrine::test
