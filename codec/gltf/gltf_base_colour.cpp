// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_base_colour.h"

#include <algorithm>

#include "codec/gltf/gltf_surface.h"
#include "codec/picture/decode_picture.h"
#include "codec/picture/sample.h"

namespace vitrine::inline codec {

namespace {

// Returns the colour in which emitted light is shown. Light that is too bright for a picture is
// scaled down, which keeps its hue.
LinearColour shown(const Vec3& emission) {
  const double most = std::max({1.0, emission.x, emission.y, emission.z});
  return {emission.x / most, emission.y / most, emission.z / most};
}

}  // namespace

LinearColour BaseColour::at(double u, double v) const {
  if (picture == nullptr) return factor;
  const auto [x, y] = texture.transform.at(u, v);
  return factor * sample(*picture, x, y, texture.wrap_u, texture.wrap_v);
}

BaseColour GltfBaseColours::of(const Json& primitive) {
  const Json& material = element(document_, "materials", whole(primitive, "material", kAbsent));
  const GltfSurface surface = surface_of(material);
  const auto& [r, g, b, opacity] = surface.colour;
  const bool emits = surface.only_emits();
  BaseColour out{.factor = emits ? shown(surface.emission) : LinearColour{r, g, b}};
  const auto texture =
      read_texture(document_, emits ? surface.emission_texture : surface.colour_texture);
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
  const SpanKey key{bytes->data(), bytes->size()};
  auto known = by_span_.find(key);
  if (known == by_span_.end()) known = by_span_.emplace(key, decode(*bytes)).first;
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
