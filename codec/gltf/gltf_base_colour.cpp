// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_base_colour.h"

#include <algorithm>

#include "codec/picture/decode_picture.h"
#include "codec/picture/sample.h"

namespace vitrine::inline codec {

LinearColour BaseColour::at(double u, double v) const {
  if (picture == nullptr) return factor;
  const auto [x, y] = texture.transform.at(u, v);
  return factor * sample(*picture, x, y, texture.wrap_u, texture.wrap_v);
}

BaseColour GltfBaseColours::of(const Json& primitive) {
  const Json& material = element(document_, "materials", whole(primitive, "material", kAbsent));
  const Json& surface = member(material, "pbrMetallicRoughness");
  const auto factor = numbers<4>(member(surface, "baseColorFactor"), {1, 1, 1, 1});
  BaseColour out{.factor = {factor[0], factor[1], factor[2]}};
  const auto texture = read_texture(document_, member(surface, "baseColorTexture"));
  if (!texture) return out;
  out.texture = *texture;
  out.picture = picture(texture->image);
  return out;
}

const Picture* GltfBaseColours::picture(std::uint64_t index) {
  const auto [it, is_new] = decoded_.try_emplace(index);
  if (is_new) {
    const auto found = find(index);
    if (found)
      it->second = *found;
    else
      pictures_.refuse(index, found.error().message);
  }
  return it->second;
}

Expected<const Picture*> GltfBaseColours::find(std::uint64_t index) {
  const auto bytes = pictures_.bytes(index);
  if (!bytes) return tl::unexpected(bytes.error());
  const Place place{bytes->data(), bytes->size()};
  auto known = by_place_.find(place);
  if (known == by_place_.end()) known = by_place_.emplace(place, decode(*bytes)).first;
  if (!known->second) return tl::unexpected(known->second.error());
  return &*known->second;
}

Expected<Picture> GltfBaseColours::decode(std::span<const std::uint8_t> bytes) {
  if (auto ok = check_picture_format(bytes); !ok) return tl::unexpected(ok.error());
  auto picture = decode_picture_within(pixels_left_, bytes);
  if (!picture) pixels_left_ -= std::min<std::uint64_t>(pixels_left_, bytes.size());
  return picture;
}

std::size_t GltfBaseColours::decoded() const {
  return static_cast<std::size_t>(std::count_if(
      decoded_.begin(), decoded_.end(), [](const auto& entry) { return entry.second != nullptr; }));
}

}  // namespace vitrine::inline codec
