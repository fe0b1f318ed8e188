// SPDX-License-Identifier: Apache-2.0
#include "codec/import/fbx_materials.h"

#include <assimp/material.h>
#include <assimp/scene.h>

#include <array>
#include <cstdlib>
#include <map>
#include <string_view>

namespace vitrine::inline codec {
namespace {

// A kind of map that a mesh does not keep, and its name in messages.
struct LostMap {
  aiTextureType type;
  std::string_view name;
};
constexpr std::array<LostMap, 6> kLostMaps{{{aiTextureType_SPECULAR, "SpecularColor"},
                                            {aiTextureType_SHININESS, "ShininessExponent"},
                                            {aiTextureType_METALNESS, "metalness"},
                                            {aiTextureType_DIFFUSE_ROUGHNESS, "roughness"},
                                            {aiTextureType_AMBIENT_OCCLUSION, "occlusion"},
                                            {aiTextureType_DISPLACEMENT, "DisplacementColor"}}};

std::string embedded_name(std::size_t index) {
  return "embedded picture " + std::to_string(index);
}

// Returns the name by which a picture is found among the companions (the files beside the model).
// Assimp writes "*" and an index for an embedded picture without a name.
std::string picture_name(const aiScene& scene, const aiString& path) {
  const std::string name = path.C_Str();
  if (!name.starts_with('*')) return name;
  const auto index = static_cast<std::size_t>(std::strtoul(name.c_str() + 1, nullptr, 10));
  return index < scene.mNumTextures ? embedded_name(index) : name;
}

bool is_mirror_or_repeat(aiTextureMapMode mode) {
  return mode == aiTextureMapMode_Wrap || mode == aiTextureMapMode_Mirror;
}

// Returns the first map of one of these types, or an empty map.
ObjMap first_map(const aiScene& scene, const aiMaterial& material,
                 std::initializer_list<aiTextureType> types) {
  for (const aiTextureType type : types) {
    aiString path;
    std::array<aiTextureMapMode, 3> modes{aiTextureMapMode_Wrap, aiTextureMapMode_Wrap,
                                          aiTextureMapMode_Wrap};
    if (material.GetTexture(type, 0, &path, nullptr, nullptr, nullptr, nullptr, modes.data()) !=
        aiReturn_SUCCESS)
      continue;
    ObjMap map{.name = picture_name(scene, path)};
    map.is_clamped = !is_mirror_or_repeat(modes[0]) && !is_mirror_or_repeat(modes[1]);
    aiUVTransform transform;
    if (material.Get(AI_MATKEY_UVTRANSFORM(type, 0), transform) == aiReturn_SUCCESS) {
      map.scale = {transform.mScaling.x, transform.mScaling.y};
      map.offset = {transform.mTranslation.x, transform.mTranslation.y};
    }
    return map;
  }
  return {};
}

ObjMaterial read_fbx_material(const aiScene& scene, const aiMaterial& material) {
  ObjMaterial out{.opacity_map_name = "TransparentColor", .bump_map_name = "Bump"};
  const auto map = [&](std::initializer_list<aiTextureType> types) {
    return first_map(scene, material, types);
  };
  out.diffuse_map = map({aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE});
  out.normal_map = map({aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA});
  out.bump_map = map({aiTextureType_HEIGHT});
  out.emission_map = map({aiTextureType_EMISSION_COLOR, aiTextureType_EMISSIVE});
  out.opacity_map = map({aiTextureType_OPACITY});
  aiColor3D colour;
  if (material.Get(AI_MATKEY_BASE_COLOR, colour) == aiReturn_SUCCESS ||
      material.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS)
    out.diffuse = {colour.r, colour.g, colour.b};
  if (material.Get(AI_MATKEY_COLOR_EMISSIVE, colour) == aiReturn_SUCCESS)
    out.emission = {colour.r, colour.g, colour.b};
  float opacity = 1;
  // Some programs write an opacity of 0 for an opaque material.
  if (material.Get(AI_MATKEY_OPACITY, opacity) == aiReturn_SUCCESS && opacity > 0 && opacity < 1)
    out.opacity = opacity;
  return out;
}

}  // namespace

Companions with_embedded_pictures(const aiScene& scene, const Companions& beside) {
  Companions all = beside;
  std::map<std::string, Companions> by_name;  // pictures grouped by name
  for (std::size_t i = 0; i < scene.mNumTextures; ++i) {
    const aiTexture& picture = *scene.mTextures[i];
    // If Assimp sets the height of a picture, the picture is an array of pixels instead of a file.
    // FBX files have no such pictures.
    if (picture.mHeight != 0 || picture.pcData == nullptr) continue;
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(picture.pcData), picture.mWidth);
    all[companion_key(embedded_name(i))] = bytes;
    if (picture.mFilename.length == 0) continue;
    const std::string path = picture.mFilename.C_Str();
    all[companion_key(path)] = by_name[name_key(path)][companion_key(path)] = bytes;
  }
  // The path of a picture in a material may differ from the path that the picture itself states. A
  // picture with a unique name is therefore also found by its name alone.
  for (const auto& [name, pictures] : by_name) {
    if (pictures.size() == 1) all[name] = pictures.begin()->second;
  }
  return all;
}

std::vector<std::string> define_fbx_materials(const aiScene& scene, ObjMaterials& materials,
                                              std::set<std::string>& unread) {
  std::vector<std::string> names;
  std::set<std::string> used;
  for (std::size_t i = 0; i < scene.mNumMaterials; ++i) {
    const aiMaterial& material = *scene.mMaterials[i];
    std::string name = material.GetName().C_Str();
    // Assimp adds a default material, which has two properties. A material of the file may have the
    // same name, but it has more properties, because Assimp stores each of its colours twice.
    constexpr unsigned kNameAndColour = 2;
    if (name == AI_DEFAULT_MATERIAL_NAME && material.mNumProperties == kNameAndColour) {
      names.emplace_back();
      continue;
    }
    name.resize(without_end_blanks(name).size());
    if (name.empty() || !used.insert(name).second) name += " " + std::to_string(i);
    materials.define(name, read_fbx_material(scene, material));
    names.push_back(std::move(name));
    for (const LostMap& lost : kLostMaps) {
      if (material.GetTextureCount(lost.type) > 0) unread.emplace(lost.name);
    }
  }
  return names;
}

}  // namespace vitrine::inline codec
