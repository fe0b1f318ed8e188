// SPDX-License-Identifier: Apache-2.0
#include "masked_pictures.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "checked.h"
#include "codec/atlas/raster.h"
#include "codec/bake/atlas_picture.h"
#include "codec/core/limits.h"
#include "codec/core/srgb.h"
#include "codec/picture/decode_picture.h"
#include "codec/picture/write_picture.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

Picture decoded(const TexturedModel& model, std::uint32_t picture) {
  return checked(decode_picture(model.texturing.pictures[picture].bytes, Limits{}.pixels));
}

bool is_colour(const Texturing& texturing, std::uint32_t picture) {
  return std::ranges::any_of(texturing.materials, [&](const Material& material) {
    const auto uses = [&](const std::optional<TextureMap>& map) {
      return map && map->picture == picture;
    };
    return uses(material.base_colour_map) || uses(material.emission_map);
  });
}

AtlasPicture to_atlas(const Picture& picture, bool is_srgb) {
  AtlasPicture out{.side = picture.width,
                   .texels = std::vector<TexelValue>(picture.pixels.size() / 4),
                   .covered = std::vector<float>(picture.pixels.size() / 4)};
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const double value = picture.pixels[i] / 255.0;
    out.texels[i / 4][i % 4] =
        static_cast<float>(is_srgb && i % 4 < 3 ? srgb_to_linear(value) : value);
  }
  return out;
}

// Marks the texels that a face touches. Coordinates outside the picture wrap around, because the
// picture repeats.
void cover(const TextureMap& map, const std::array<TextureCoordinates, 3>& corners,
           AtlasPicture& atlas) {
  const auto side = static_cast<std::int32_t>(atlas.side);
  std::array<Vec2, 3> at;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [u, v] = map.transform.at(corners[k][0], corners[k][1]);
    at[k] = Vec2{u, v} * side;
  }
  const auto inside = [side](std::int32_t i) {
    return static_cast<std::size_t>(((i % side) + side) % side);
  };
  rasterise(at, [&](std::int32_t y, std::int32_t first, std::int32_t last) {
    for (std::int32_t x = first; x <= std::min(last, first + side - 1); ++x)
      atlas.covered[inside(y) * atlas.side + inside(x)] = 1;
  });
}

void cover_charts(const Texturing& texturing, std::uint32_t picture, AtlasPicture& atlas) {
  for (std::size_t f = 0; f < texturing.face_materials.size(); ++f) {
    for_each_map(texturing.materials[texturing.face_materials[f]], [&](const TextureMap& map) {
      if (map.picture == picture) cover(map, texturing.coordinates[0][f], atlas);
    });
  }
}

}  // namespace

std::vector<SizedPicture> masked_pictures(const TexturedModel& model, std::uint32_t picture) {
  const Picture source = decoded(model, picture);
  if (source.width != source.height)
    throw std::runtime_error(model.name + " has a picture that is not square");
  const bool is_srgb = is_colour(model.texturing, picture);
  AtlasPicture atlas = to_atlas(source, is_srgb);
  cover_charts(model.texturing, picture, atlas);
  std::vector<SizedPicture> out;
  for (;;) {
    const bool is_last = atlas.side / 2 < kLeastSide || atlas.side % 2 != 0;
    AtlasPicture smaller;
    if (!is_last) smaller = halved(atlas);
    fill_uncovered(atlas);
    out.push_back(
        {atlas.side, checked(write_webp(to_picture(atlas, is_srgb, true), kPictureQuality))});
    if (is_last) break;
    atlas = std::move(smaller);
  }
  std::ranges::reverse(out);
  return out;
}

std::vector<std::uint8_t> unmasked_picture(const TexturedModel& model, std::uint32_t picture) {
  return checked(write_webp(decoded(model, picture), kPictureQuality));
}

std::vector<std::uint32_t> used_pictures(const Texturing& texturing,
                                         std::span<const MapOfMaterial> maps) {
  std::set<std::uint32_t> used;
  for (const Material& material : texturing.materials) {
    for (const MapOfMaterial map : maps) {
      if (material.*map) used.insert((material.*map)->picture);
    }
  }
  return {used.begin(), used.end()};
}

}  // namespace vitrine::bench
