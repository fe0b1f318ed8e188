// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_surface.h"

#include <algorithm>

#include "codec/core/linear_colour.h"

namespace vitrine::inline codec {
namespace {

constexpr double kMostEmissive = 1e6;

double unit_factor(const Json& object, std::string_view key) {
  return std::clamp(real(object, key, 1), 0.0, 1.0);
}

std::array<double, 4> colour_factor(const Json& object, std::string_view key) {
  auto colour = numbers<4>(member(object, key), {1, 1, 1, 1});
  for (double& part : colour)
    part = std::clamp(part, 0.0, 1.0);
  return colour;
}

Vec3 emission_of(const Json& material) {
  const auto colour = numbers<3>(member(material, "emissiveFactor"), {0, 0, 0});
  const double strength =
      real(extension(material, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
  const auto part = [&](double value) { return std::clamp(value * strength, 0.0, kMostEmissive); };
  return {part(colour[0]), part(colour[1]), part(colour[2])};
}

}  // namespace

bool GltfSurface::only_emits() const {
  return to_srgb({colour[0], colour[1], colour[2]}) == Colour{0, 0, 0} && emission != Vec3{};
}

GltfSurface surface_of(const Json& material) {
  const Vec3 emission = emission_of(material);
  const Json& emission_texture = member(material, "emissiveTexture");
  const Json& glossy = extension(material, kSpecularGlossiness);
  if (glossy.is_object()) {
    // The glossiness texture is not read. A surface with such a texture counts as rough.
    const bool has_map = member(glossy, "specularGlossinessTexture").is_object();
    return {.colour = colour_factor(glossy, "diffuseFactor"),
            .colour_texture = member(glossy, "diffuseTexture"),
            .metallic = 0,
            .roughness = has_map ? 1 : 1 - unit_factor(glossy, "glossinessFactor"),
            .metallic_roughness_texture = member(glossy, ""),
            .emission = emission,
            .emission_texture = emission_texture};
  }
  const Json& surface = member(material, "pbrMetallicRoughness");
  return {.colour = colour_factor(surface, "baseColorFactor"),
          .colour_texture = member(surface, "baseColorTexture"),
          .metallic = unit_factor(surface, "metallicFactor"),
          .roughness = unit_factor(surface, "roughnessFactor"),
          .metallic_roughness_texture = member(surface, "metallicRoughnessTexture"),
          .emission = emission,
          .emission_texture = emission_texture};
}

}  // namespace vitrine::inline codec
