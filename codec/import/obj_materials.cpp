// SPDX-License-Identifier: Apache-2.0
#include "codec/import/obj_materials.h"

#include <algorithm>

#include "codec/import/text_cursor.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t'))
    text.remove_suffix(1);
  return text;
}

// Returns the file name of a map. If options such as "-s 1 1 1" precede it, the name is the last
// word. Otherwise it is the whole text, which may contain blanks.
std::string_view map_name(std::string_view rest) {
  rest = trimmed(rest);
  return rest.starts_with('-') ? rest.substr(rest.find_last_of(" \t") + 1) : rest;
}

}  // namespace

bool ObjMaterials::open_library(std::string_view name) {
  const auto bytes = find_companion(companions_, trimmed(name));
  if (!bytes) return false;
  TextCursor text(*bytes);
  Material* material = nullptr;
  while (text.seek_word()) {
    const std::string_view keyword = text.word();
    if (keyword == "newmtl") {
      material = &materials_[std::string(trimmed(text.rest_of_line()))];
    } else if (keyword == "map_Kd" && material != nullptr) {
      material->map = map_name(text.rest_of_line());
    } else if (keyword == "Kd" && material != nullptr) {
      std::array<double, 3> kd;
      if (text.read_number(kd[0]) && text.read_number(kd[1]) && text.read_number(kd[2])) {
        material->diffuse = to_linear({to_byte(kd[0]), to_byte(kd[1]), to_byte(kd[2])});
      }
    }
    text.next_line();
  }
  return true;
}

void ObjMaterials::use(std::string_view name) {
  const auto it = materials_.find(trimmed(name));
  current_ = nullptr;
  if (it == materials_.end()) return;
  Material& material = it->second;
  if (!material.is_used && !material.map.empty()) material.picture = pictures_.find(material.map);
  material.is_used = true;
  current_ = &material;
}

LinearColour ObjMaterials::colour_at(double u, double v) const {
  if (current_ == nullptr) return {1, 1, 1};
  return current_->picture == nullptr ? current_->diffuse
                                      : sample_upwards(*current_->picture, u, v);
}

std::vector<std::string> ObjMaterials::report() const {
  std::vector<std::string> lines = pictures_.report();
  const bool has_plain = std::any_of(materials_.begin(), materials_.end(), [](const auto& entry) {
    return entry.second.is_used && entry.second.picture == nullptr;
  });
  if (has_plain) lines.emplace_back("material colours baked into vertex colours");
  return lines;
}

}  // namespace vitrine::inline codec
