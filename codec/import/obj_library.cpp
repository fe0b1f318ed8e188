// SPDX-License-Identifier: Apache-2.0
#include "codec/import/obj_library.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "codec/import/readers.h"
#include "codec/import/stated_colours.h"
#include "codec/import/text_cursor.h"

namespace vitrine::inline codec {
namespace {

// A statement that names a texture map: its keyword in lower case, and the member that stores the
// map.
struct MapStatement {
  std::string_view keyword;
  ObjMap ObjMaterial::*map;
};
constexpr std::array<MapStatement, 7> kMaps{{{"map_kd", &ObjMaterial::diffuse_map},
                                             {"map_d", &ObjMaterial::opacity_map},
                                             {"norm", &ObjMaterial::normal_map},
                                             {"map_kn", &ObjMaterial::normal_map},
                                             {"map_bump", &ObjMaterial::bump_map},
                                             {"bump", &ObjMaterial::bump_map},
                                             {"map_ke", &ObjMaterial::emission_map}}};

constexpr std::array<std::string_view, 10> kUnreadMaps{
    "map_Ka", "map_Ks", "map_Ns", "map_Pr", "map_Pm", "map_Ps", "map_Tr", "disp", "decal", "refl"};

constexpr double kMostEmission = 1e6;

// The faults of a diffuse colour, as the ends of messages about "colours of 2 materials".
constexpr std::string_view
    kClippedDiffuse = " clipped to the range 0 to 1; write Kd with numbers from 0 to 1",
    kWideDiffuse = " read as 0 to 255; write Kd with numbers from 0 to 1",
    kCommasInDiffuse = " not carried: numbers have decimal commas; write them with points",
    kUnreadDiffuse = " not carried: Kd is not red, green and blue; write it as three numbers";

// An option of a map statement, and the largest number of values that may follow it. Options with
// numbers may have fewer values.
struct MapOption {
  std::string_view name;
  std::size_t values;
  bool are_numbers = false;
};
constexpr std::array<MapOption, 12> kMapOptions{{{"-s", 3, true},
                                                 {"-o", 3, true},
                                                 {"-t", 3, true},
                                                 {"-mm", 2, true},
                                                 {"-bm", 1, true},
                                                 {"-boost", 1, true},
                                                 {"-texres", 1, true},
                                                 {"-blendu", 1},
                                                 {"-blendv", 1},
                                                 {"-cc", 1},
                                                 {"-clamp", 1},
                                                 {"-imfchan", 1}}};

constexpr float kMostTextureScale = 1e6;

std::string_view first_of(std::string_view text) {
  return text.substr(0, text.find_first_of(" \t"));
}

void drop_first(std::string_view& text) {
  text.remove_prefix(first_of(text).size());
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
}

bool is_number(std::string_view word) {
  double value = 0;
  const char* end = word.data() + word.size();
  return !word.empty() && std::from_chars(word.data(), end, value).ptr == end;
}

// Returns the first two numbers of an option. A number that is missing or larger than
// kMostTextureScale becomes `otherwise`.
std::array<float, 2> numbers_of(const std::vector<std::string_view>& values, float otherwise) {
  std::array<float, 2> out{otherwise, otherwise};
  for (std::size_t i = 0; i < std::min(values.size(), out.size()); ++i) {
    float value = otherwise;
    std::from_chars(values[i].data(), values[i].data() + values[i].size(), value);
    if (std::abs(value) <= kMostTextureScale) out[i] = value;
  }
  return out;
}

std::vector<std::string_view> take_values(const MapOption& option, std::string_view& rest) {
  std::vector<std::string_view> values;
  while (values.size() < option.values && !rest.empty()) {
    if (option.are_numbers && !is_number(first_of(rest))) break;
    values.push_back(first_of(rest));
    drop_first(rest);
  }
  return values;
}

// Reads the options and the file name of a map. The name may contain blanks, unless an unknown
// option precedes it.
ObjMap read_map_name(std::string_view rest) {
  ObjMap out;
  rest = without_end_blanks(rest);
  while (rest.starts_with('-')) {
    const auto* option =
        std::ranges::find(kMapOptions, lower_case(first_of(rest)), &MapOption::name);
    if (option == kMapOptions.end()) {
      rest = rest.substr(rest.find_last_of(" \t") + 1);
      break;
    }
    drop_first(rest);
    const auto values = take_values(*option, rest);
    if (option->name == "-s") out.scale = numbers_of(values, 1);
    if (option->name == "-o") out.offset = numbers_of(values, 0);
    if (option->name == "-clamp" && values == std::vector<std::string_view>{"on"})
      out.is_clamped = true;
  }
  out.name = without_quotes(rest);
  return out;
}

// Reads red, green and blue. If only red is stated, green and blue equal it.
std::optional<std::array<double, 3>> read_colour(TextCursor& text) {
  std::array<double, 3> out;
  if (!text.read_number(out[0])) return std::nullopt;
  if (text.line_is_done()) return std::array{out[0], out[0], out[0]};
  const bool ok = text.read_number(out[1]) && text.read_number(out[2]);
  return ok ? std::optional(out) : std::nullopt;
}

bool is_out_of_range(double part) {
  return !(part >= 0 && part <= 1);
}

void read_diffuse(TextCursor& text, ObjMaterial& out) {
  const TextCursor begin = text;
  if (const auto colour = read_colour(text)) {
    out.diffuse = colour;
    out.diffuse_fault = std::ranges::any_of(*colour, is_out_of_range) ? kClippedDiffuse : "";
  } else if (begin.has_decimal_comma()) {
    out.diffuse_fault = kCommasInDiffuse;
  } else {
    out.diffuse_fault = kUnreadDiffuse;
  }
}

// Scales the diffuse colours of one library if they range from 0 to 255.
void scale_diffuse(const std::set<ObjMaterial*>& materials) {
  std::vector<StatedColour> stated;
  for (const ObjMaterial* material : materials) {
    if (!material->diffuse) continue;
    const auto [r, g, b] = *material->diffuse;
    stated.push_back({static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)});
  }
  if (!are_up_to_255(stated)) return;
  for (ObjMaterial* material : materials) {
    if (!material->diffuse) continue;
    for (double& part : *material->diffuse)
      part /= 255;
    const bool is_clipped = std::ranges::any_of(*material->diffuse, is_out_of_range);
    material->diffuse_fault = is_clipped ? kClippedDiffuse : kWideDiffuse;
  }
}

// Reads a number in the range 0 to 1. Returns `otherwise` if there is no number.
double read_unit(TextCursor& text, double otherwise) {
  double value = otherwise;
  text.read_number(value);
  return value >= 0 ? std::min(value, 1.0) : 0;
}

// Returns a component of the emission. Numbers that are negative, too large or not finite become 0.
double emitted(double value) {
  return value >= 0 && value <= kMostEmission ? value : 0;
}

void read_statement(std::string_view keyword, TextCursor& text, ObjMaterial& out) {
  if (keyword == "kd") {
    read_diffuse(text, out);
  } else if (keyword == "ke") {
    if (const auto colour = read_colour(text))
      out.emission = {emitted((*colour)[0]), emitted((*colour)[1]), emitted((*colour)[2])};
  } else if (keyword == "d") {
    out.opacity = read_unit(text, out.opacity);
  } else if (keyword == "tr") {
    out.opacity = 1 - read_unit(text, 1 - out.opacity);
  } else if (keyword == "pm") {
    out.metallic = read_unit(text, out.metallic);
  } else if (keyword == "pr") {
    out.roughness = read_unit(text, out.roughness);
  }
}

void read_map(std::string_view keyword, TextCursor& text, std::string_view folder,
              ObjMaterial& out) {
  const auto* map = std::ranges::find(kMaps, keyword, &MapStatement::keyword);
  if (map != kMaps.end()) {
    out.*(map->map) = read_map_name(text.rest_of_line());
    (out.*(map->map)).folder = folder;
  } else if (const auto* unread = std::ranges::find(kUnreadMaps, keyword, lower_case);
             unread != kUnreadMaps.end()) {
    out.unread.insert(*unread);
  }
}

}  // namespace

std::string_view without_quotes(std::string_view name) {
  const bool quoted = name.size() > 2 && name.front() == '"' && name.back() == '"';
  return quoted ? name.substr(1, name.size() - 2) : name;
}

std::string_view without_end_blanks(std::string_view text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t'))
    text.remove_suffix(1);
  return text;
}

void read_obj_library(std::span<const std::uint8_t> bytes, std::string_view folder,
                      ObjLibrary& out) {
  TextCursor text(without_mark(bytes));
  ObjMaterial* material = nullptr;
  std::set<ObjMaterial*> materials;
  while (text.seek_word()) {
    const std::string keyword = lower_case(text.word());
    if (keyword == "newmtl") {
      material = &out[std::string(without_end_blanks(text.rest_of_line()))];
      materials.insert(material);
    } else if (material != nullptr) {
      read_statement(keyword, text, *material);
      read_map(keyword, text, folder, *material);
    }
    text.next_line();
  }
  scale_diffuse(materials);
}

}  // namespace vitrine::inline codec
