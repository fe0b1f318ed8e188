// SPDX-License-Identifier: Apache-2.0
#include "codec/import/gltf_material.h"

#include <algorithm>
#include <cmath>

#include "codec/picture/decode_picture.h"
#include "codec/picture/sample.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

Wrap wrap_of(const Json& sampler, std::string_view key) {
  constexpr std::uint64_t kClampToEdge = 33071, kMirroredRepeat = 33648;
  const std::uint64_t mode = whole(sampler, key, 0);
  return mode == kClampToEdge      ? Wrap::kClamp
         : mode == kMirroredRepeat ? Wrap::kMirror
                                   : Wrap::kRepeat;
}

void place_texture(const Json& reference, const Json& sampler, BaseColour& out) {
  out.texcoord = whole(reference, "texCoord", 0);
  out.wrap_u = wrap_of(sampler, "wrapS");
  out.wrap_v = wrap_of(sampler, "wrapT");
  const Json& transform = extension(reference, "KHR_texture_transform");
  out.texcoord = whole(transform, "texCoord", out.texcoord);
  out.offset = numbers<2>(member(transform, "offset"), {0, 0});
  out.scale = numbers<2>(member(transform, "scale"), {1, 1});
  out.rotation = real(transform, "rotation", 0);
}

// Returns the image of a texture. Prefers WebP, as EXT_texture_webp says, to the plain image.
// Without either, returns the image of another extension, so that a message can name its format.
std::uint64_t source_of(const Json& texture) {
  std::uint64_t source =
      whole(extension(texture, "EXT_texture_webp"), "source", whole(texture, "source", kAbsent));
  for (const Json& other : member(texture, "extensions")) {
    if (source == kAbsent) source = whole(other, "source", kAbsent);
  }
  return source;
}

}  // namespace

LinearColour BaseColour::at(double u, double v) const {
  if (image == nullptr) return factor;
  const double c = std::cos(rotation), s = std::sin(rotation);
  const double x = scale[0] * u, y = scale[1] * v;
  return factor *
         sample(*image, offset[0] + c * x + s * y, offset[1] + c * y - s * x, wrap_u, wrap_v);
}

BaseColour GltfMaterials::base_colour(const Json& primitive) {
  const Json& material = element(document_, "materials", whole(primitive, "material", kAbsent));
  const Json& surface = member(material, "pbrMetallicRoughness");
  const auto factor = numbers<4>(member(surface, "baseColorFactor"), {1, 1, 1, 1});
  BaseColour out{.factor = {factor[0], factor[1], factor[2]}};
  const Json& reference = member(surface, "baseColorTexture");
  const Json& texture = element(document_, "textures", whole(reference, "index", kAbsent));
  if (!texture.is_object()) return out;
  out.image = image(source_of(texture));
  place_texture(reference, element(document_, "samplers", whole(texture, "sampler", kAbsent)), out);
  return out;
}

const Picture* GltfMaterials::image(std::uint64_t index) {
  const auto [it, is_new] = images_.try_emplace(index);
  if (is_new) {
    auto decoded = decode(index);
    if (decoded) {
      pixels_left_ -= std::uint64_t{decoded->width} * decoded->height;
      it->second = *std::move(decoded);
    } else {
      faults_.push_back("texture map " +
                        (index == kAbsent ? std::string() : std::to_string(index) + ' ') +
                        "not carried: it " + decoded.error().message);
    }
  }
  return it->second ? &*it->second : nullptr;
}

Expected<Picture> GltfMaterials::decode(std::uint64_t index) {
  const Json& self = element(document_, "images", index);
  if (const Json& uri = member(self, "uri"); uri.is_string()) {
    const auto bytes = resources_.find(uri.get_ref<const std::string&>());
    if (!bytes) return tl::unexpected(bytes.error());
    return decode_picture(*bytes, pixels_left_);
  }
  const std::uint64_t view = whole(self, "bufferView", kAbsent);
  if (view == kAbsent) return bad_input("is not in the file");
  const auto bytes = buffer_.view(view);
  if (!bytes) return bad_input("lies beyond the end of the file");
  return decode_picture(bytes->bytes, pixels_left_);
}

std::vector<std::string> GltfMaterials::report() const {
  std::vector<std::string> lines;
  const Json& all = member(document_, "images");
  const std::uint64_t count = all.is_array() ? all.size() : 0;
  const auto baked = static_cast<std::uint64_t>(std::count_if(
      images_.begin(), images_.end(), [](const auto& entry) { return entry.second.has_value(); }));
  if (baked > 0) lines.push_back(counted(baked, "texture map") + " baked into vertex colours");
  lines.insert(lines.end(), faults_.begin(), faults_.end());
  const std::uint64_t told = baked + faults_.size();
  if (count > told) lines.push_back(counted(count - told, "texture map") + " not carried");
  return lines;
}

}  // namespace vitrine::inline codec
