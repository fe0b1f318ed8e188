// SPDX-License-Identifier: Apache-2.0
#include "codec/import/obj_library.h"

#include <algorithm>

#include "codec/import/text_cursor.h"

namespace vitrine::inline codec {
namespace {

// A statement that names a map, and where its name is stored.
struct MapStatement {
  std::string_view keyword;
  std::string ObjMaterial::*name;
};
constexpr std::array<MapStatement, 8> kMaps{{{"map_Kd", &ObjMaterial::diffuse_map},
                                             {"map_d", &ObjMaterial::opacity_map},
                                             {"norm", &ObjMaterial::normal_map},
                                             {"map_Kn", &ObjMaterial::normal_map},
                                             {"map_Bump", &ObjMaterial::bump_map},
                                             {"map_bump", &ObjMaterial::bump_map},
                                             {"bump", &ObjMaterial::bump_map},
                                             {"map_Ke", &ObjMaterial::emission_map}}};

constexpr std::array<std::string_view, 9> kUnreadMaps{
    "map_Ks", "map_Ns", "map_Pr", "map_Pm", "map_Ps", "map_Tr", "disp", "decal", "refl"};

constexpr double kMostEmission = 1e6;

// Returns the file name of a map. If options such as "-s 1 1 1" precede it, the name is the last
// word. Otherwise it is the whole text, which may contain blanks.
std::string_view map_name(std::string_view rest) {
  rest = without_end_blanks(rest);
  return rest.starts_with('-') ? rest.substr(rest.find_last_of(" \t") + 1) : rest;
}

std::optional<std::array<double, 3>> read_colour(TextCursor& text) {
  std::array<double, 3> out;
  const bool ok = text.read_number(out[0]) && text.read_number(out[1]) && text.read_number(out[2]);
  return ok ? std::optional(out) : std::nullopt;
}

// Reads a number from 0 to 1. Returns `otherwise` if there is no number.
double read_unit(TextCursor& text, double otherwise) {
  double value = otherwise;
  text.read_number(value);
  return value >= 0 ? std::min(value, 1.0) : 0;
}

// Returns a part of an emission. Numbers that are not finite become 0.
double emitted(double value) {
  return value >= 0 && value <= kMostEmission ? value : 0;
}

void read_statement(std::string_view keyword, TextCursor& text, ObjMaterial& out) {
  if (keyword == "Kd") {
    if (const auto colour = read_colour(text)) out.diffuse = colour;
  } else if (keyword == "Ke") {
    if (const auto colour = read_colour(text))
      out.emission = {emitted((*colour)[0]), emitted((*colour)[1]), emitted((*colour)[2])};
  } else if (keyword == "d") {
    out.opacity = read_unit(text, out.opacity);
  } else if (keyword == "Tr") {
    out.opacity = 1 - read_unit(text, 1 - out.opacity);
  } else if (keyword == "Pm") {
    out.metallic = read_unit(text, out.metallic);
  } else if (keyword == "Pr") {
    out.roughness = read_unit(text, out.roughness);
  }
}

void read_map(std::string_view keyword, TextCursor& text, ObjMaterial& out) {
  const auto* map = std::ranges::find(kMaps, keyword, &MapStatement::keyword);
  if (map != kMaps.end()) {
    out.*(map->name) = map_name(text.rest_of_line());
  } else if (const auto* unread = std::ranges::find(kUnreadMaps, keyword);
             unread != kUnreadMaps.end()) {
    out.unread.insert(*unread);
  }
}

}  // namespace

std::string_view without_end_blanks(std::string_view text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t'))
    text.remove_suffix(1);
  return text;
}

void read_obj_library(std::span<const std::uint8_t> bytes, ObjLibrary& out) {
  TextCursor text(bytes);
  ObjMaterial* material = nullptr;
  while (text.seek_word()) {
    const std::string_view keyword = text.word();
    if (keyword == "newmtl") {
      material = &out[std::string(without_end_blanks(text.rest_of_line()))];
    } else if (material != nullptr) {
      read_statement(keyword, text, *material);
      read_map(keyword, text, *material);
    }
    text.next_line();
  }
}

}  // namespace vitrine::inline codec
