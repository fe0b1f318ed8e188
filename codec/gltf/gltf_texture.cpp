// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_texture.h"

namespace vitrine::inline codec {
namespace {

Wrap wrap_of(const Json& sampler, std::string_view key) {
  constexpr std::uint64_t kClampToEdge = 33071, kMirroredRepeat = 33648;
  const std::uint64_t mode = whole(sampler, key, 0);
  return mode == kClampToEdge      ? Wrap::kClamp
         : mode == kMirroredRepeat ? Wrap::kMirror
                                   : Wrap::kRepeat;
}

// Returns the image of a texture. Prefers the WebP image of EXT_texture_webp to the plain image. If
// both are missing, returns the image of any other extension, so that an error message can name the
// image's format.
std::uint64_t source_of(const Json& texture) {
  std::uint64_t source =
      whole(extension(texture, "EXT_texture_webp"), "source", whole(texture, "source", kAbsent));
  for (const Json& other : member(texture, "extensions")) {
    if (source == kAbsent) source = whole(other, "source", kAbsent);
  }
  return source;
}

}  // namespace

std::optional<GltfTexture> read_texture(const Json& document, const Json& reference) {
  constexpr std::uint64_t kNearest = 9728;
  const Json& texture = element(document, "textures", whole(reference, "index", kAbsent));
  if (!texture.is_object()) return std::nullopt;
  const Json& sampler = element(document, "samplers", whole(texture, "sampler", kAbsent));
  const Json& transform = extension(reference, "KHR_texture_transform");
  return GltfTexture{.image = source_of(texture),
                     .texcoord = whole(transform, "texCoord", whole(reference, "texCoord", 0)),
                     .is_nearest = whole(sampler, "magFilter", 0) == kNearest,
                     .wrap_u = wrap_of(sampler, "wrapS"),
                     .wrap_v = wrap_of(sampler, "wrapT"),
                     .transform = {.offset = numbers<2>(member(transform, "offset"), {0, 0}),
                                   .scale = numbers<2>(member(transform, "scale"), {1, 1}),
                                   .rotation = real(transform, "rotation", 0)}};
}

}  // namespace vitrine::inline codec
