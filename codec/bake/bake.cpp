// SPDX-License-Identifier: Apache-2.0
#include "codec/bake/bake.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "codec/bake/draw_atlas_picture.h"
#include "codec/bake/role_maps.h"
#include "codec/core/limits.h"
#include "codec/core/printable.h"
#include "codec/picture/decode_picture.h"
#include "codec/picture/write_picture.h"

namespace vitrine::inline codec {
namespace {

constexpr double kMostSide = 8192, kLeastSide = 64;
// Largest side, in pixels, of the smallest picture of a role.
constexpr std::uint32_t kCoarsestSide = 256;
// WebP qualities (0 to 100) to try for the finest picture, best first. Stops at the first quality
// at which the picture needs no more bytes than the source's pictures. With a best quality below
// 88, small models would look visibly worse than their sources (codec/simplify/TEXTURES.md, section
// 7).
constexpr std::array<int, 5> kQualities = {88, 84, 80, 75, 70};
constexpr std::array<int, 3> kSurfaceQualities = {80, 75, 70};
// WebP qualities of the smaller pictures: kQuality for sides above kLargestCoarse pixels, else
// kCoarseQuality. Coarse pictures may be worse because a viewer soon replaces them. Lowering their
// quality saves more bytes than lowering their size (codec/simplify/TEXTURES.md, section 8).
constexpr int kQuality = 80, kCoarseQuality = 60;
constexpr std::uint32_t kLargestCoarse = 640;
// Number of texels of the finest picture per texel of the source, on each axis. It exceeds 1
// because resampling blurs. Pictures of occlusion, roughness and metalness have half as many texels
// on each axis, because the eye hardly sees their detail.
constexpr double kDensity = 1.14, kSurfaceDensity = kDensity / 2;

double doubled_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return std::abs(cross(b - a, c - a));
}

// Decodes the pictures of `maps`. If a picture cannot be decoded, removes its maps and adds a note.
std::vector<Picture> decode_intact(std::span<const MapOfMaterial> maps, Texturing& texturing,
                                   std::vector<std::string>& notes) {
  std::vector<Picture> pictures(texturing.pictures.size());
  std::vector<bool> is_damaged(pictures.size());
  std::uint64_t pixels_left = Limits{}.pixels;
  const auto decode = [&](std::uint32_t i) {
    if (!pictures[i].pixels.empty() || is_damaged[i]) return;
    auto picture = decode_picture_within(pixels_left, texturing.pictures[i].bytes);
    if (picture) {
      pictures[i] = *std::move(picture);
      return;
    }
    is_damaged[i] = true;
    const std::string& name = texturing.pictures[i].name;
    notes.push_back("1 texture map, " + (name.empty() ? std::to_string(i) : in_quotes(name)) +
                    ", left out: it " + picture.error().message);
  };
  for (Material& material : texturing.materials) {
    for (const MapOfMaterial map : maps) {
      if (material.*map) decode((material.*map)->picture);
      if (material.*map && is_damaged[(material.*map)->picture]) (material.*map).reset();
    }
  }
  return pictures;
}

// Returns how many texels of a map's picture a face covers.
double texels_of(const TextureMap& map, const Picture& picture,
                 const std::array<TextureCoordinates, 3>& corners) {
  std::array<Vec2, 3> at;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [u, v] = map.transform.at(corners[k][0], corners[k][1]);
    at[k] = {u * picture.width, v * picture.height};
  }
  return doubled_area(at[0], at[1], at[2]) / 2;
}

// Returns how many texels per side the display atlas needs to show the faces that have the map `of`
// as finely as the source does. A picture that repeats counts at most four times.
double side_for(MapOfMaterial of, const Texturing& texturing, const std::vector<Picture>& pictures,
                std::span<const DisplayFace> display) {
  double texels = 0, area = 0, most = 0;
  std::vector<bool> is_counted(pictures.size());
  for (std::size_t f = 0; f < display.size(); ++f) {
    const auto& map = texturing.materials[texturing.face_materials[f]].*of;
    if (!map) continue;
    const Picture& picture = pictures[map->picture];
    const double size = static_cast<double>(picture.width) * picture.height;
    if (!is_counted[map->picture]) most += 4 * size;
    is_counted[map->picture] = true;
    texels += texels_of(*map, picture, texturing.coordinates[map->coordinates][f]);
    area += doubled_area(display[f][0], display[f][1], display[f][2]) / 2;
  }
  return std::sqrt(std::min(texels, most) / std::max(area, 1e-4));
}

// Returns the side of the finest picture of a role. It is a multiple of 64, so that the sides of
// the smaller pictures are whole numbers.
std::uint32_t finest_side(PictureRole role, const Texturing& texturing,
                          const std::vector<Picture>& pictures,
                          std::span<const DisplayFace> display) {
  const double density = role == PictureRole::kSurface ? kSurfaceDensity : kDensity;
  double side = kLeastSide;
  for (const MapOfMaterial map : maps_of(role))
    side = std::max(side, density * side_for(map, texturing, pictures, display));
  return static_cast<std::uint32_t>(std::ceil(std::min(side, kMostSide) / 64)) * 64;
}

// Returns the total size in bytes of the source's pictures for a role.
std::uint64_t bytes_of_source(const Texturing& texturing, PictureRole role) {
  std::vector<bool> counted(texturing.pictures.size());
  std::uint64_t bytes = 0;
  for (const Material& material : texturing.materials) {
    for (const MapOfMaterial of : maps_of(role)) {
      const auto& map = material.*of;
      if (!map || counted[map->picture]) continue;
      counted[map->picture] = true;
      bytes += texturing.pictures[map->picture].bytes.size();
    }
  }
  return bytes;
}

Expected<std::vector<std::uint8_t>> encoded(const Picture& picture, int quality) {
  auto bytes = write_webp(picture, quality);
  if (bytes) return bytes;
  return fail(bytes.error().code,
              "the picture of the texture: " + bytes.error().message + "; use smaller ones");
}

// Encodes a picture with the first of `qualities` at which it needs at most `most_bytes`. If there
// is none, uses the last quality.
Expected<std::vector<std::uint8_t>> encode_within(std::uint64_t most_bytes, const Picture& picture,
                                                  std::span<const int> qualities) {
  for (const int quality : qualities.first(qualities.size() - 1)) {
    auto bytes = encoded(picture, quality);
    if (!bytes || bytes->size() <= most_bytes) return bytes;
  }
  return encoded(picture, qualities.back());
}

// Returns the side of an extra picture, or nullopt if the finest picture has at most kLargestCoarse
// pixels per side. Halving `finest` repeatedly gives one side that is above kLargestCoarse and at
// most twice that. The extra picture has three quarters of this side, because web pages usually
// show a model at about that size.
std::optional<std::uint32_t> side_between(std::uint32_t finest) {
  std::uint32_t side = finest;
  while (side > 2 * kLargestCoarse)
    side /= 2;
  if (side <= kLargestCoarse) return {};
  return side * 3 / 4;
}

// Fills the uncovered texels of a picture, encodes it by encode_within() and adds it to `out`.
Expected<void> add_picture(AtlasPicture atlas, PictureRole role, std::span<const int> qualities,
                           std::uint64_t most_bytes, BakedTexture& out) {
  const bool has_opacity = role == PictureRole::kBaseColour && out.alpha_mode != AlphaMode::kOpaque;
  fill_uncovered(atlas);
  auto bytes = encode_within(most_bytes, to_picture(atlas, is_srgb(role), has_opacity), qualities);
  if (!bytes) return tl::unexpected(bytes.error());
  out.pictures.push_back({role, atlas.side, std::move(*bytes)});
  return {};
}

// Adds the picture and its smaller versions. Each version has half the side of the previous one.
Expected<void> add_halvings(AtlasPicture atlas, PictureRole role, std::uint64_t most_bytes,
                            BakedTexture& out) {
  std::span<const int> qualities = kQualities;
  if (role == PictureRole::kSurface) qualities = kSurfaceQualities;
  for (;;) {
    const bool is_coarsest = atlas.side <= kCoarsestSide;
    AtlasPicture smaller;
    if (!is_coarsest) smaller = halved(atlas);
    if (auto ok = add_picture(std::move(atlas), role, qualities, most_bytes, out); !ok) return ok;
    if (is_coarsest) return {};
    atlas = std::move(smaller);
    qualities = std::span(atlas.side > kLargestCoarse ? &kQuality : &kCoarseQuality, 1);
  }
}

void set_surface(const Texturing& texturing, BakedTexture& out) {
  for (const Material& material : texturing.materials) {
    out.alpha_mode = std::max(out.alpha_mode, material.alpha_mode);
    if (material.alpha_mode == AlphaMode::kMask) out.alpha_cutoff = material.alpha_cutoff;
    out.is_double_sided |= material.is_double_sided;
  }
  out.is_unlit = std::ranges::all_of(texturing.materials, &Material::is_unlit);
}

// Adds the pictures of one role. To save memory, decodes only the pictures that this role needs.
Expected<void> add_role(PictureRole role, const TriangleMesh& mesh, Texturing& texturing,
                        std::span<const DisplayFace> display, BakedTexture& out) {
  auto pictures = decode_intact(maps_of(role), texturing, out.notes);
  const std::uint32_t side = finest_side(role, texturing, pictures, display);
  const std::uint64_t most_bytes = bytes_of_source(texturing, role);
  const Textures textures(texturing, std::move(pictures));
  const auto draw = [&](std::uint32_t of) {
    return draw_atlas_picture(role, of, mesh, textures, display);
  };
  if (auto ok = add_halvings(draw(side), role, most_bytes, out); !ok) return ok;
  const auto between = side_between(side);
  if (!between) return {};
  return add_picture(draw(*between), role, std::span(&kQuality, 1), most_bytes, out);
}

}  // namespace

Expected<BakedTexture> bake(const TriangleMesh& mesh, Texturing texturing,
                            std::span<const DisplayFace> display) {
  BakedTexture out;
  set_surface(texturing, out);
  for (std::uint8_t i = 0; i < kPictureRoles; ++i) {
    const auto role = static_cast<PictureRole>(i);
    const auto needs_role = [role](const Material& material) { return needs(material, role); };
    if (std::ranges::none_of(texturing.materials, needs_role)) continue;
    if (auto ok = add_role(role, mesh, texturing, display, out); !ok) {
      return tl::unexpected(ok.error());
    }
  }
  std::ranges::stable_sort(out.pictures, {}, [](const BakedPicture& picture) {
    return std::pair(picture.side, picture.role);
  });
  const auto first = std::ranges::find(out.pictures, PictureRole::kBaseColour, &BakedPicture::role);
  std::rotate(out.pictures.begin(), first, first + 1);
  return out;
}

}  // namespace vitrine::inline codec
