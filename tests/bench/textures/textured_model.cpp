// SPDX-License-Identifier: Apache-2.0
#include "textured_model.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "bench/codec/peers.h"
#include "checked.h"
#include "codec/core/limits.h"
#include "codec/files/companions.h"
#include "codec/import/read_mesh.h"
#include "codec/render/material_pictures.h"
#include "codec/repair/repair.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

namespace fs = std::filesystem;

Bytes bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

bool has_extension(const fs::path& path, const std::set<std::string>& extensions) {
  return extensions.contains(path.extension().string());
}

// Returns the contents of the files beside `path` to which a mesh file may refer.
std::map<std::string, Bytes> files_beside(const fs::path& path) {
  std::map<std::string, Bytes> files;
  for (const auto& entry : fs::directory_iterator(path.parent_path())) {
    if (has_extension(entry.path(), {".bin", ".mtl", ".jpg", ".jpeg", ".png", ".webp"}))
      files.emplace(companion_key(entry.path().string()), bytes_of(entry.path()));
  }
  return files;
}

bool has_colour_map(const Texturing& texturing) {
  return std::ranges::any_of(texturing.materials, [](const Material& material) {
    return material.base_colour_map.has_value();
  });
}

std::optional<TexturedModel> read_model(const fs::path& path) {
  const Bytes file = bytes_of(path);
  const auto beside = files_beside(path);
  ReadOptions options;
  for (const auto& [key, bytes] : beside)
    options.beside.emplace(key, bytes);
  TexturedModel model{.name = path.stem().string(), .imported = checked(read_mesh(file, options))};
  if (!has_colour_map(model.imported.texturing)) return {};
  if (!model.imported.texturing.coordinates[1].empty()) {
    std::fprintf(stderr, "bench-textures: %s is left out; it has two sets of coordinates\n",
                 path.c_str());
    return {};
  }
  RepairedMesh repaired = checked(repair(model.imported));
  model.mesh = std::move(repaired.mesh);
  model.mesh.attributes.colours.clear();  // the pictures contain the colours
  model.texturing = std::move(repaired.texturing);
  return model;
}

BuildResult build_with(ImportedMesh imported, int bits) {
  BuildOptions options;
  options.bits = bits;
  return checked(build_model(std::move(imported), options, {}));
}

}  // namespace

BuildResult TexturedModel::build(int bits) const {
  return build_with(imported, bits);
}

BuildResult TexturedModel::build_untextured(bool has_colours) const {
  ImportedMesh bare = imported;
  bare.texturing = {};
  if (!has_colours) bare.mesh.attributes.colours.clear();
  return build_with(std::move(bare), kBits);
}

AppearanceReference TexturedModel::reference() const {
  const Textures textures(texturing,
                          checked(decode_pictures(texturing, kShownMaps, Limits{}.pixels)));
  return checked(AppearanceReference::of({.mesh = mesh, .textures = &textures}));
}

std::vector<TexturedModel> read_textured_models(const fs::path& path) {
  std::vector<TexturedModel> models;
  const auto add = [&](const fs::path& file) {
    if (auto model = read_model(file)) models.push_back(std::move(*model));
  };
  if (!fs::is_directory(path)) {
    add(fs::absolute(path));
  } else {
    for (const auto& entry : fs::directory_iterator(path)) {
      if (has_extension(entry.path(), {".glb", ".gltf", ".obj", ".ply"})) add(entry.path());
    }
  }
  if (models.empty()) throw std::runtime_error("no textured model in " + path.string());
  std::ranges::sort(models, {}, [](const TexturedModel& model) { return model.mesh.faces.size(); });
  return models;
}

}  // namespace vitrine::bench
