// SPDX-License-Identifier: Apache-2.0
// Reads Wavefront OBJ: vertices with optional r g b colours, polygons, and diffuse colours of
// materials.
#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "codec/import/named_pictures.h"
#include "codec/import/obj_colours.h"
#include "codec/import/obj_materials.h"
#include "codec/import/readers.h"
#include "codec/import/text_cursor.h"

namespace vitrine::inline codec {
namespace {

class ObjReader {
 public:
  ObjReader(std::span<const std::uint8_t> bytes, const ReadOptions& options)
      : text_(bytes), materials_(options.beside, options.limits) {
    mesh_.format = "OBJ";
    mesh_.first_number = 1;
  }

  Expected<RawMesh> read() {
    while (seek_statement()) {
      const std::string keyword = lower_case(text_.word().substr(0, 32));
      if (!take(keyword)) return bad_line(keyword);
      text_.next_line();
    }
    finish_materials();
    materials_.give_to(mesh_);
    return std::move(mesh_);
  }

 private:
  // Moves to the next statement. Reads the comments before that statement, because they may hold
  // colours.
  bool seek_statement() {
    while (text_.line_is_done()) {
      if (text_.is_at_end()) return false;
      colours_.read_comment(text_.rest_of_line());
      text_.next_line();
    }
    return true;
  }

  // Reads the statement after its keyword. Returns false if the statement is faulty.
  bool take(const std::string& keyword) {
    if (keyword == "v") return read_vertex();
    if (keyword == "f" || keyword == "fo") return read_face();
    if (keyword == "vt")
      texture_coordinates();
    else if (keyword == "vn")
      mesh_.has_seams = true;
    else if (keyword == "mtllib")
      open_libraries(text_.rest_of_line());
    else if (keyword == "usemtl")
      use_material(text_.rest_of_line());
    else
      count_other_statement(keyword);
    return true;
  }

  bool read_vertex() {
    std::array<float, 4> extra;
    Vec3 p;
    if (!text_.read_number(p.x) || !text_.read_number(p.y) || !text_.read_number(p.z)) return false;
    std::size_t count = 0;
    while (count < extra.size() && text_.read_number(extra[count]))
      ++count;
    colours_.add(mesh_.positions.size(), std::span(extra).first(count));
    mesh_.positions.push_back(p);
    return true;
  }

  void texture_coordinates() {
    std::array<float, 2> at{};
    if (text_.read_number(at[0])) text_.read_number(at[1]);
    places_.push_back(at);
    mesh_.has_seams = true;
  }

  // Counts the statements for elements that are not polygons (points, lines, curves and surfaces)
  // and the statements that are unknown. The other statements group or smooth faces, or belong to a
  // curve or surface.
  void count_other_statement(const std::string& keyword) {
    constexpr std::array<std::string_view, 5> kElements{"p", "l", "curv", "curv2", "surf"};
    constexpr std::array<std::string_view, 25> kWithoutFaces{
        "g",      "s",        "o",     "mg",    "vp",   "bevel",      "c_interp", "lod",  "deg",
        "cstype", "d_interp", "bmat",  "step",  "parm", "trim",       "hole",     "scrv", "sp",
        "end",    "con",      "ctech", "stech", "res",  "shadow_obj", "trace_obj"};
    if (std::ranges::find(kElements, keyword) != kElements.end())
      ++other_elements_[keyword];
    else if (std::ranges::find(kWithoutFaces, keyword) == kWithoutFaces.end())
      count_unknown(keyword);
  }

  void count_unknown(const std::string& keyword) {
    constexpr std::size_t kMostNamed = 4;
    ++unknown_;
    if (unknown_names_.size() < kMostNamed) unknown_names_.insert(in_quotes(keyword));
  }

  void report_other_statements() {
    std::uint64_t count = 0;
    std::string statements;
    for (const auto& [keyword, uses] : other_elements_) {
      count += uses;
      add_to_list(statements, counted(uses, keyword + " statement"));
    }
    if (count > 0)
      mesh_.repairs.push_back(counted(count, "element") + " without faces (" + statements +
                              ") not carried; convert what you need to polygons");
    std::string names;
    for (const std::string& name : unknown_names_)
      add_to_list(names, name);
    if (unknown_ > 0)
      mesh_.repairs.push_back(counted(unknown_, "unknown statement") + " not carried (" + names +
                              "); if they hold faces or colours, export the model as PLY or GLB");
  }

  static void add_to_list(std::string& list, const std::string& item) {
    list += (list.empty() ? "" : ", ") + item;
  }

  // Opens the libraries named in a statement. Blanks separate the names, but a name may also
  // contain blanks. The longest sequence of words that names a library is therefore tried first.
  void open_libraries(std::string_view names) {
    constexpr std::size_t kMostWords = 8;
    names_library_ = true;
    for (names = without_end_blanks(names); !names.empty();) {
      std::vector<std::size_t> ends;
      for (std::size_t end = 0; ends.size() < kMostWords && end < names.size();) {
        end =
            std::min(names.find_first_of(" \t", names.find_first_not_of(" \t", end)), names.size());
        ends.push_back(end);
      }
      const auto found = std::find_if(ends.rbegin(), ends.rend(), [&](std::size_t end) {
        return materials_.open_library(names.substr(0, end)).has_value();
      });
      const std::size_t end = found == ends.rend() ? take_missing(names, ends) : *found;
      names.remove_prefix(std::min(names.find_first_not_of(" \t", end), names.size()));
    }
  }

  // Records that a library is missing. Call this if no sequence of words at the start of `names` is
  // the name of a library. Returns the end of the missing library's name.
  std::size_t take_missing(std::string_view names, const std::vector<std::size_t>& ends) {
    const auto end = std::ranges::find_if(
        ends, [&](std::size_t at) { return lower_case(names.substr(0, at)).ends_with(".mtl"); });
    const std::size_t size = end == ends.end() ? ends.front() : *end;
    constexpr std::size_t kMostNamed = 8;
    const std::string_view name = names.substr(0, size);
    if (missing_libraries_.size() < kMostNamed)
      missing_libraries_.try_emplace(as_utf8(name), materials_.open_library(name).error().message);
    return size;
  }

  void use_material(std::string_view name) {
    // The faces read before the first `usemtl` statement have no material.
    if (mesh_.face_count() > 0 && !has_material_) materials_.plain();
    has_material_ = true;
    if (!names_library_) before_library_.emplace(without_end_blanks(name));
    mesh_.use_material(materials_.use(name));
  }

  // A corner is written as v, v/vt, v//vn or v/vt/vn. Trailing fields may be empty, as in v//.
  // Negative numbers count back from the last vertex.
  bool read_face() {
    corners_.clear();
    at_corners_.clear();
    while (!text_.line_is_done()) {
      std::int64_t v = 0;
      if (!text_.read_number(v, '/')) return false;
      if (v < 0) v += static_cast<std::int64_t>(mesh_.positions.size()) + 1;
      if (v <= 0) return false;
      corners_.push_back(static_cast<std::uint32_t>(std::min<std::int64_t>(v - 1, 0xFFFF'FFFF)));
      std::int64_t vt = 0;
      if (text_.skip('/') && !text_.is_after_word()) text_.read_number(vt, '/');
      if (text_.skip('/') && !text_.is_after_word()) text_.word();
      const auto place = place_of(vt);
      if (materials_.has_current()) add_sample(corners_.back(), place);
      if (materials_.has_maps()) at_corners_.push_back(from_upwards(place[0], place[1]));
    }
    is_cut_ = corners_.size() < 3 && text_.is_at_end();
    mesh_.add_face(corners_, text_.line(), at_corners_);
    return !is_cut_;
  }

  // Returns the texture coordinate of a corner. `vt` counts from 1; negative numbers count back
  // from the last coordinate. 0 means that the corner has no texture coordinate.
  std::array<float, 2> place_of(std::int64_t vt) const {
    const auto count = static_cast<std::int64_t>(places_.size());
    if (vt < 0) vt += count + 1;
    const bool known = vt > 0 && vt <= count;
    return known ? places_[static_cast<std::size_t>(vt - 1)] : std::array<float, 2>{};
  }

  // Adds the material's colour at a corner to the mean colour of the corner's vertex.
  void add_sample(std::uint32_t vertex, const std::array<float, 2>& place) {
    if (vertex >= mesh_.positions.size()) return;
    means_.resize(mesh_.positions.size());
    means_.add(vertex, materials_.colour_at(place[0], place[1]));
  }

  void finish_materials() {
    std::vector<std::string>& lines = mesh_.repairs;
    if (!colours_.empty()) {
      if (!means_.empty() && materials_.are_plain())
        lines.push_back(counted(materials_.used(), "material") +
                        " not carried: the vertices have colours of their own; remove these to use "
                        "the materials");
      mesh_.attributes.colours = colours_.take(mesh_.positions.size(), lines);
    } else if (!means_.empty()) {
      means_.resize(mesh_.positions.size());
      mesh_.attributes.colours = means_.take();
      mesh_.is_baked = true;
      lines = materials_.report_baked();
    } else if (missing_libraries_.empty() && !places_.empty()) {
      lines.push_back(counted(places_.size(), "texture coordinate") +
                      " not carried; to use them, name a material with a texture map");
    }
    for (const auto& [name, fault] : missing_libraries_)
      lines.push_back("1 material library " + in_quotes(name) + " not carried: it " + fault);
    report_other_statements();
    report_materials_before_library();
    const auto unread = materials_.report_unread();
    lines.insert(lines.end(), unread.begin(), unread.end());
  }

  // A `usemtl` statement has no effect before the file has named a library.
  void report_materials_before_library() {
    if (before_library_.empty()) return;
    mesh_.repairs.push_back(counted(before_library_.size(), "material") + " not carried, such as " +
                            in_quotes(*before_library_.begin()) +
                            ": the file names no material library before it uses them; add a line "
                            "mtllib with the name of the .mtl file at its start");
  }

  Unexpected bad_line(std::string_view keyword) const {
    const bool vertex = keyword == "v";
    if (vertex && text_.has_decimal_comma()) {
      return bad_input("OBJ line " + std::to_string(text_.line()) + ": " +
                       std::string(kDecimalCommas));
    }
    if (is_cut_) {
      return bad_input("OBJ line " + std::to_string(text_.line()) +
                       ": the file ends within this face; it is cut short, copy it again");
    }
    return bad_input("OBJ line " + std::to_string(text_.line()) +
                     (vertex ? ": a vertex needs three numbers"
                             : ": a face needs vertex numbers from 1, or from -1 back to the first "
                               "vertex") +
                     "; correct the line or export the file again");
  }

  TextCursor text_;
  RawMesh mesh_;
  ObjColours colours_;
  std::vector<std::uint32_t> corners_;          // corners of the face being read
  std::vector<TextureCoordinates> at_corners_;  // coordinates; empty if no material has a map
  ObjMaterials materials_;
  std::vector<std::array<float, 2>> places_;              // all texture coordinates of the file
  ColourMeans means_;                                     // mean material colours
  std::map<std::string, std::uint64_t> other_elements_;   // key: keyword
  std::uint64_t unknown_ = 0;                             // number of unknown statements
  std::set<std::string> unknown_names_;                   // the first few of their keywords
  std::map<std::string, std::string> missing_libraries_;  // name -> why it is not read
  std::set<std::string> before_library_;  // materials used before the first `mtllib` statement
  bool names_library_ = false;            // whether a `mtllib` statement was read
  bool has_material_ = false;             // whether a `usemtl` statement was read
  bool is_cut_ = false;                   // whether the file ends before a face's third corner
};

}  // namespace

bool is_obj(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::string_view, 6> kKeywords{"vp", "f", "s", "l", "p", "cstype"};
  // These keywords may have capitals. A capital S or P begins many other texts.
  constexpr std::array<std::string_view, 7> kInAnyCase{"v", "vn",     "vt",    "o",
                                                       "g", "mtllib", "usemtl"};
  const std::string_view word = first_word(bytes);
  return std::ranges::count(kKeywords, word) > 0 ||
         std::ranges::count(kInAnyCase, lower_case(word.substr(0, 8))) > 0;
}

Expected<RawMesh> read_obj(std::span<const std::uint8_t> bytes, const ReadOptions& options) {
  return ObjReader(bytes, options).read();
}

}  // namespace vitrine::inline codec
