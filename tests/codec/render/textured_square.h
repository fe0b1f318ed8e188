// SPDX-License-Identifier: Apache-2.0
// A square with one picture, seen from the front. The square fills the view.
#pragma once

#include <functional>

#include "codec/render/render.h"

namespace vitrine::test {

// Returns a picture. `pixel(x, y)` gives the red, green, blue and opacity of each pixel.
inline Picture picture_of(std::uint32_t width, std::uint32_t height,
                          const std::function<std::array<std::uint8_t, 4>(int, int)>& pixel) {
  Picture picture{width, height, {}};
  for (int y = 0; y < static_cast<int>(height); ++y) {
    for (int x = 0; x < static_cast<int>(width); ++x) {
      const auto bytes = pixel(x, y);
      picture.pixels.insert(picture.pixels.end(), bytes.begin(), bytes.end());
    }
  }
  return picture;
}

inline Picture plain_picture(const std::array<std::uint8_t, 4>& pixel) {
  return picture_of(1, 1, [&](int, int) { return pixel; });
}

// A square with the corners (±1, ±1, 0). Its texture coordinates are (0, 0) at the upper left and
// (1, 1) at the lower right. Its material is white and unlit and has no maps.
struct TexturedSquare {
  TriangleMesh mesh{.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
                    .faces = {{0, 1, 2}, {0, 2, 3}},
                    .attributes = {}};
  Texturing texturing{
      .materials = {{.is_unlit = true}},
      .pictures = {},
      .face_materials = {0, 0},
      .coordinates = {{{{{{0, 1}, {1, 1}, {1, 0}}}, {{{0, 1}, {1, 0}, {0, 0}}}}, {}}}};
  std::vector<Picture> pictures;

  Material& material() { return texturing.materials[0]; }

  // Gives the square a base colour map with this picture. Returns the map.
  TextureMap& show(Picture picture) {
    pictures = {std::move(picture)};
    return material().base_colour_map.emplace();
  }

  // Renders the square to a picture of `size` x `size` pixels, which the square fills.
  Picture seen(std::uint32_t size) const {
    const Textures textures(texturing, pictures);
    return render(
        {.mesh = mesh, .normals = std::vector(4, Vec3{0, 0, 1}), .textures = &textures},
        {.centre = {}, .pixel = 2.0 / size, .width = size, .height = size, .toward = {0, 0, 1}});
  }
};

inline std::array<int, 4> pixel_of(const Picture& picture, std::uint32_t x, std::uint32_t y) {
  const std::uint8_t* pixel = &picture.pixels[4 * (std::size_t{y} * picture.width + x)];
  return {pixel[0], pixel[1], pixel[2], pixel[3]};
}

}  // namespace vitrine::test
