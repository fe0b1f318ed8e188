// SPDX-License-Identifier: Apache-2.0
#include "codec/render/shown_pictures.h"

#include <string>

#include "codec/picture/decode_picture.h"

namespace vitrine::inline codec {
namespace {

std::vector<bool> shown_pictures(const Texturing& texturing) {
  std::vector<bool> shown(texturing.pictures.size());
  for (const Material& material : texturing.materials) {
    for (const auto& map : {material.base_colour_map, material.normal_map}) {
      if (map) shown[map->picture] = true;
    }
  }
  return shown;
}

std::string name_of(const EncodedPicture& picture, std::size_t index) {
  return "picture " + (picture.name.empty() ? std::to_string(index) : picture.name);
}

}  // namespace

Expected<std::vector<Picture>> decode_shown_pictures(const Texturing& texturing,
                                                     std::uint64_t most_pixels) {
  const std::vector<bool> shown = shown_pictures(texturing);
  std::vector<Picture> pictures(shown.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (!shown[i]) continue;
    const EncodedPicture& encoded = texturing.pictures[i];
    auto picture = decode_picture(encoded.bytes, most_pixels);
    if (!picture) {
      return fail(picture.error().code,
                  name_of(encoded, i) + ' ' + std::move(picture.error().message));
    }
    most_pixels -= std::uint64_t{picture->width} * picture->height;
    pictures[i] = *std::move(picture);
  }
  return pictures;
}

}  // namespace vitrine::inline codec
