// SPDX-License-Identifier: Apache-2.0
#include "codec/render/material_pictures.h"

#include <string>

#include "codec/picture/decode_picture.h"

namespace vitrine::inline codec {
namespace {

std::vector<bool> used_pictures(const Texturing& texturing, std::span<const MapOfMaterial> maps) {
  std::vector<bool> used(texturing.pictures.size());
  for (const Material& material : texturing.materials) {
    for (const MapOfMaterial map : maps) {
      if (material.*map) used[(material.*map)->picture] = true;
    }
  }
  return used;
}

std::string name_of(const EncodedPicture& picture, std::size_t index) {
  return "picture " + (picture.name.empty() ? std::to_string(index) : picture.name);
}

}  // namespace

Expected<std::vector<Picture>> decode_pictures(const Texturing& texturing,
                                               std::span<const MapOfMaterial> maps,
                                               std::uint64_t most_pixels) {
  const std::vector<bool> used = used_pictures(texturing, maps);
  std::vector<Picture> pictures(used.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
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
