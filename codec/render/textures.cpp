// SPDX-License-Identifier: Apache-2.0
#include "codec/render/textures.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vitrine::inline codec {
namespace {

using Corners = std::array<TextureCoordinates, 3>;

Corners transformed(const Corners& corners, const TextureTransform& transform) {
  Corners result;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto [u, v] = transform.at(corners[i][0], corners[i][1]);
    result[i] = {static_cast<float>(u), static_cast<float>(v)};
  }
  return result;
}

// Returns how far a step of one sample moves in the texture, in pixels: the larger of the distances
// for a step to the right and a step down.
double longest_step(const MipMap& mip_map, const Corners& uv, const ScreenTriangle& triangle) {
  const auto& [a, b, c] = triangle.corners();
  const Vec3 ab = b - a, ac = c - a;
  const auto steps = [&](std::size_t axis, double size) {
    const double first = (uv[1][axis] - uv[0][axis]) * size / triangle.signed_area();
    const double second = (uv[2][axis] - uv[0][axis]) * size / triangle.signed_area();
    return std::array{first * ac.y - second * ab.y, second * ab.x - first * ac.x};
  };
  const auto u = steps(0, mip_map.width()), v = steps(1, mip_map.height());
  return std::sqrt(std::max(u[0] * u[0] + v[0] * v[0], u[1] * u[1] + v[1] * v[1]));
}

bool is_white(const Material& material) {
  const auto& [red, green, blue, opacity] = material.base_colour;
  return red == 1 && green == 1 && blue == 1 && !material.base_colour_map;
}

}  // namespace

FaceTexture::FaceTexture(const MipMap& mip_map, const TextureMap& map,
                         const std::array<TextureCoordinates, 3>& corners,
                         const ScreenTriangle& triangle)
    : mip_map_(&mip_map),
      map_(&map),
      corners_(transformed(corners, map.transform)),
      level_(std::log2(longest_step(mip_map, corners_, triangle))) {}

Texel FaceTexture::at(const Barycentric& weights) const {
  TextureCoordinates uv;
  for (std::size_t i = 0; i < uv.size(); ++i)
    uv[i] = static_cast<float>(corners_[0][i] * weights.u + corners_[1][i] * weights.v +
                               corners_[2][i] * weights.w);
  if (map_->is_nearest && level_ <= 0) return mip_map_->nearest(uv, map_->wrap_u, map_->wrap_v);
  return mip_map_->at(uv, level_, map_->wrap_u, map_->wrap_v);
}

Textures::Textures(Texturing texturing, std::vector<Picture> pictures)
    : texturing_(std::move(texturing)),
      pictures_(std::move(pictures)),
      colours_(pictures_.size()),
      values_(pictures_.size()),
      are_white_(std::ranges::all_of(texturing_.materials, is_white)) {
  for (const Material& material : texturing_.materials) {
    for (const MapOfMaterial map : kMapsOfMaterial) {
      if (is_colour(map)) add(colours_, material.*map, PictureCoding::kSrgb);
      if (!is_colour(map)) add(values_, material.*map, PictureCoding::kValues);
    }
  }
}

void Textures::add(MipMaps& mip_maps, const std::optional<TextureMap>& map, PictureCoding coding) {
  if (!map || mip_maps[map->picture]) return;
  const Picture& picture = pictures_[map->picture];
  if (!picture.pixels.empty()) mip_maps[map->picture].emplace(picture, coding);
}

std::optional<FaceTexture> Textures::map(MapOfMaterial of, std::uint32_t face,
                                         const ScreenTriangle& triangle) const {
  const std::optional<TextureMap>& map = material(face).*of;
  const MipMaps& mip_maps = is_colour(of) ? colours_ : values_;
  if (!map || !mip_maps[map->picture]) return std::nullopt;
  return FaceTexture(*mip_maps[map->picture], *map, texturing_.coordinates[map->coordinates][face],
                     triangle);
}

}  // namespace vitrine::inline codec
