// SPDX-License-Identifier: Apache-2.0
#include "codec/build/exported_texture.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "codec/picture/decode_picture.h"
#include "codec/picture/write_picture.h"

namespace vitrine::inline codec {
namespace {

// least size of a picture in pixels per face; see codec/simplify/TEXTURES.md, section 7
constexpr std::uint64_t kPixelsPerFace = 16;
constexpr int kJpegQuality = 92;

std::uint64_t pixels_of(const PictureInfo& picture) {
  return std::uint64_t{picture.side} * picture.side;
}

// Whether picture `a` is a better choice than `b` for a use that needs `pixels` pixels. Prefers the
// smallest picture that has enough pixels, or else the largest picture.
bool is_better(const PictureInfo& a, const PictureInfo& b, std::uint64_t pixels) {
  const bool a_suffices = pixels_of(a) >= pixels, b_suffices = pixels_of(b) >= pixels;
  if (a_suffices != b_suffices) return a_suffices;
  return a_suffices ? a.side < b.side : a.side > b.side;
}

// Whether picture `a` is a better choice than `b` for a use that allows at most `most` pixels per
// side. Prefers the largest picture that is allowed, or else the smallest picture.
bool is_closer(const PictureInfo& a, const PictureInfo& b, std::uint32_t most) {
  const bool a_fits = a.side <= most, b_fits = b.side <= most;
  if (a_fits != b_fits) return a_fits;
  return a_fits ? a.side > b.side : a.side < b.side;
}

Unexpected undecoded(std::size_t number, const Error& error) {
  return fail(error.code, "picture " + std::to_string(number) + " of the texture " + error.message);
}

Expected<EncodedPicture> converted(std::size_t number, const PictureInfo& info, bool has_opacity,
                                   const PictureReader& read) {
  const auto bytes = read(number);
  if (!bytes) return tl::unexpected(bytes.error());
  const auto picture = decode_picture(*bytes, pixels_of(info));
  if (!picture) return undecoded(number, picture.error());
  auto file = has_opacity ? write_png(*picture) : write_jpeg(*picture, kJpegQuality);
  if (!file) return undecoded(number, file.error());
  return EncodedPicture{.name = std::string(name_of(info.role)) + (has_opacity ? ".png" : ".jpg"),
                        .bytes = std::move(*file)};
}

// Makes the material use picture number `picture` of the texturing.
void use(PictureRole role, std::uint32_t picture, Material& material) {
  const TextureMap map{.picture = picture, .wrap_u = Wrap::kClamp, .wrap_v = Wrap::kClamp};
  switch (role) {
    case PictureRole::kBaseColour:
      material.base_colour_map = map;
      return;
    case PictureRole::kNormal:
      material.normal_map = map;
      return;
    case PictureRole::kSurface:
      material.metallic_roughness_map = material.occlusion_map = map;
      material.metallic = material.roughness = 1;
      return;
    case PictureRole::kEmission:
      material.emission_map = map;
      material.emission = {1, 1, 1};
      return;
  }
}

}  // namespace

std::vector<std::size_t> pictures_to_export(const Manifest& manifest, std::uint64_t faces,
                                            std::optional<std::uint32_t> most_side,
                                            PictureRoles roles) {
  const TextureInfo& texture = manifest.texture;
  if (most_side == 0u) return {};
  const bool is_finest = faces >= manifest.levels.back().faces;
  const std::uint64_t pixels = is_finest ? UINT64_MAX : kPixelsPerFace * faces;
  std::array<std::optional<std::size_t>, kPictureRoles> best;
  for (std::size_t i = 0; i < texture.pictures.size(); ++i) {
    const PictureInfo& picture = texture.pictures[i];
    if (!roles.test(static_cast<std::size_t>(picture.role))) continue;
    auto& chosen = best[static_cast<std::size_t>(picture.role)];
    const auto wins = [&](const PictureInfo& other) {
      return most_side ? is_closer(picture, other, *most_side) : is_better(picture, other, pixels);
    };
    if (!chosen || wins(texture.pictures[*chosen])) chosen = i;
  }
  std::vector<std::size_t> numbers;
  for (const auto& chosen : best) {
    if (chosen) numbers.push_back(*chosen);
  }
  return numbers;
}

Expected<Texturing> texturing_to_export(const Refiner& refiner,
                                        std::span<const std::size_t> numbers,
                                        const PictureReader& read) {
  Texturing out;
  const TextureInfo& texture = refiner.manifest().texture;
  if (numbers.empty()) return out;
  Material material{.name = "texture",
                    .alpha_mode = texture.alpha_mode,
                    .alpha_cutoff = texture.alpha_cutoff,
                    .is_double_sided = texture.is_double_sided,
                    .is_unlit = texture.is_unlit};
  for (const std::size_t number : numbers) {
    const PictureInfo& info = texture.pictures[number];
    const bool has_opacity =
        info.role == PictureRole::kBaseColour && texture.alpha_mode != AlphaMode::kOpaque;
    auto picture = converted(number, info, has_opacity, read);
    if (!picture) return tl::unexpected(picture.error());
    use(info.role, static_cast<std::uint32_t>(out.pictures.size()), material);
    out.pictures.push_back(std::move(*picture));
  }
  out.materials.push_back(std::move(material));
  out.face_materials.assign(refiner.face_count(), 0);
  out.coordinates[0] = refiner.texture_coordinates();
  return out;
}

}  // namespace vitrine::inline codec
