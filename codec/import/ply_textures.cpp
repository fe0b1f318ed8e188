// SPDX-License-Identifier: Apache-2.0
#include "codec/import/ply_textures.h"

#include <algorithm>

namespace vitrine::inline codec {
namespace {

bool has_property(const PlyHeader& header, std::string_view element,
                  bool (*is_wanted)(const PlyProperty&)) {
  return std::ranges::any_of(header.elements, [&](const PlyElement& candidate) {
    return candidate.name == element && std::ranges::any_of(candidate.properties, is_wanted);
  });
}

bool lacks_numbers(const PlyHeader& header) {
  return header.textures.size() > 1 && !has_property(header, "face", is_texnumber);
}

}  // namespace

std::vector<const Picture*> find_pictures(const PlyHeader& header, NamedPictures& pictures) {
  std::vector<const Picture*> found;
  if (!has_texture_coordinates(header) || lacks_numbers(header)) return found;
  for (const std::string& name : header.textures)
    found.push_back(pictures.find({name}));
  return found;
}

bool has_texture_coordinates(const PlyHeader& header) {
  return has_property(header, "face", is_texcoord) ||
         (has_property(header, "vertex", is_vertex_u) &&
          has_property(header, "vertex", is_vertex_v));
}

bool is_vertex_u(const PlyProperty& property) {
  return !property.is_list &&
         (property.name == "u" || property.name == "s" || property.name == "texture_u");
}

bool is_vertex_v(const PlyProperty& property) {
  return !property.is_list &&
         (property.name == "v" || property.name == "t" || property.name == "texture_v");
}

PlyTextures::PlyTextures(const PlyHeader& header, NamedPictures& pictures)
    : pictures_(pictures),
      count_(header.textures.size()),
      has_coordinates_(has_texture_coordinates(header)) {
  if (!has_coordinates_) return;
  lacks_numbers_ = lacks_numbers(header);
  if (lacks_numbers_) return;
  bool has_picture = false;
  for (const std::string& name : header.textures) {
    Material& material = materials_.emplace_back(Material{.name = name});
    const auto picture = pictures.carry({name});
    if (!picture) continue;
    material.base_colour_map = TextureMap{.picture = *picture};
    has_picture = true;
  }
  if (!has_picture) materials_ = {};
}

std::uint16_t PlyTextures::material_of(std::uint32_t number) {
  if (number < count_) return static_cast<std::uint16_t>(number);
  if (materials_.size() == count_) materials_.emplace_back();
  return static_cast<std::uint16_t>(count_);
}

void PlyTextures::give_to(RawMesh& mesh) {
  if (count_ > 0 && !has_coordinates_) {
    mesh.repairs.push_back(counted(count_, "texture map") +
                           " not carried: the file has no texture coordinates; export them, too");
  }
  if (lacks_numbers_) {
    mesh.repairs.push_back(
        counted(count_, "texture map") +
        " not carried: the faces do not say which one they use; export them with "
        "texnumber");
  }
  if (materials_.empty()) return;
  mesh.materials = std::move(materials_);
  mesh.pictures = pictures_.take();
}

}  // namespace vitrine::inline codec
