// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_materials.h"

#include <algorithm>

#include "codec/gltf/gltf_surface.h"
#include "codec/gltf/gltf_texture.h"
#include "codec/mesh/plain_material.h"

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kMostMaterials = 0x10000;

double factor(const Json& object, std::string_view key, double otherwise) {
  return std::clamp(real(object, key, otherwise), 0.0, 1.0);
}

AlphaMode alpha_mode_of(const Json& self) {
  const std::string mode = text(self, "alphaMode", "");
  return mode == "MASK"    ? AlphaMode::kMask
         : mode == "BLEND" ? AlphaMode::kBlend
                           : AlphaMode::kOpaque;
}

bool is_set(const Json& self, std::string_view key) {
  const Json& value = member(self, key);
  return value.is_boolean() && value.get<bool>();
}

}  // namespace

std::uint16_t GltfMaterials::index_of(const Json& primitive) {
  const std::uint64_t number = whole(primitive, "material", kAbsent);
  const Json& self = element(document_, "materials", number);
  const auto [it, is_new] = indices_.try_emplace(self.is_object() ? number : kAbsent);
  if (!is_new) return it->second;
  if (materials_.size() == kMostMaterials) return ++materials_beyond_limit_, it->second;
  it->second = static_cast<std::uint16_t>(materials_.size());
  materials_.push_back(self.is_object() ? read(self) : Material{});
  return it->second;
}

Material GltfMaterials::read(const Json& self) {
  const GltfSurface surface = surface_of(self);
  const Json &normal = member(self, "normalTexture"), &occlusion = member(self, "occlusionTexture");
  Material out{.name = text(self, "name", "")};
  out.base_colour = surface.colour;
  out.metallic = surface.metallic;
  out.roughness = surface.roughness;
  out.normal_scale = real(normal, "scale", 1);
  out.occlusion_strength = factor(occlusion, "strength", 1);
  out.emission = surface.emission;
  out.base_colour_map = map(surface.colour_texture);
  out.normal_map = map(normal);
  out.metallic_roughness_map = map(surface.metallic_roughness_texture);
  out.occlusion_map = map(occlusion);
  out.emission_map = map(surface.emission_texture);
  out.alpha_mode = alpha_mode_of(self);
  out.alpha_cutoff = factor(self, "alphaCutoff", 0.5);
  out.is_double_sided = is_set(self, "doubleSided");
  out.is_unlit = extension(self, "KHR_materials_unlit").is_object();
  note_extensions(self);
  return out;
}

std::optional<TextureMap> GltfMaterials::map(const Json& reference) {
  const auto texture = read_texture(document_, reference);
  if (!texture || pictures_.is_refused(texture->image)) return std::nullopt;
  if (texture->texcoord >= kCoordinateSets) return ++maps_beyond_sets_, std::nullopt;
  const auto picture = carry(texture->image);
  if (!picture) return std::nullopt;
  return TextureMap{.picture = *picture,
                    .coordinates = static_cast<std::uint8_t>(texture->texcoord),
                    .is_nearest = texture->is_nearest,
                    .wrap_u = texture->wrap_u,
                    .wrap_v = texture->wrap_v,
                    .transform = texture->transform};
}

std::optional<std::uint32_t> GltfMaterials::carry(std::uint64_t image) {
  if (const auto known = carried_images_.find(image); known != carried_images_.end())
    return known->second;
  const auto bytes = pictures_.bytes(image);
  const std::uint64_t most_bytes = std::min(limits_.picture_bytes, buffer_.bytes());
  const auto index = bytes ? carried_.add(pictures_.name(image), *bytes, most_bytes)
                           : Expected<std::uint32_t>(tl::unexpected(bytes.error()));
  if (!index) return pictures_.refuse(image, index.error().message), std::nullopt;
  carried_images_.emplace(image, *index);
  return *index;
}

void GltfMaterials::note_extensions(const Json& self) {
  const Json& extensions = member(self, "extensions");
  if (!extensions.is_object()) return;
  for (const auto& [name, value] : extensions.items()) {
    if (name == kSpecularGlossiness)
      ++glossy_materials_;
    else if (name != "KHR_materials_unlit" && name != "KHR_materials_emissive_strength")
      unread_extensions_.insert(name);
  }
}

void GltfMaterials::give_to(RawMesh& mesh) {
  if (std::ranges::all_of(materials_, is_plain)) return;
  mesh.materials = std::move(materials_);
  mesh.pictures = carried_.take();
}

std::vector<std::string> GltfMaterials::report() const {
  constexpr std::size_t kMostNames = 4;
  std::vector<std::string> lines = carried_.report();
  if (!unread_extensions_.empty()) {
    std::string names;
    for (auto it = unread_extensions_.begin(); it != unread_extensions_.end(); ++it) {
      if (std::distance(unread_extensions_.begin(), it) == kMostNames) break;
      names += (names.empty() ? "" : ", ") + in_quotes(*it);
    }
    lines.push_back(counted(unread_extensions_.size(), "material extension") +
                    " not carried: " + names + "; bake them into the base colour map");
  }
  if (glossy_materials_ > 0) {
    lines.push_back("the specular colours of " + counted(glossy_materials_, "material") +
                    " not carried: only the diffuse colours are; convert the materials to "
                    "metallic-roughness");
  }
  if (maps_beyond_sets_ > 0) {
    lines.push_back(counted(maps_beyond_sets_, "use") +
                    " of a texture map not carried: it needs a third set of texture coordinates; "
                    "use TEXCOORD_0 or TEXCOORD_1");
  }
  if (materials_beyond_limit_ > 0) {
    lines.push_back(counted(materials_beyond_limit_, "material") +
                    " not carried: at most 65536 are; merge them");
  }
  return lines;
}

}  // namespace vitrine::inline codec
