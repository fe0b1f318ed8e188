// SPDX-License-Identifier: Apache-2.0
// Reads Wavefront OBJ: vertices (with the common r g b extension), polygons, and the diffuse
// colours of materials.
#include <algorithm>
#include <array>

#include "codec/import/named_pictures.h"
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
    while (text_.seek_word()) {
      const std::string_view keyword = text_.word();
      bool ok = true;
      if (keyword == "v") ok = read_vertex();
      if (keyword == "f") ok = read_face();
      if (keyword == "vt") texture_coordinates();
      if (keyword == "vn") mesh_.has_seams = true;
      if (keyword == "mtllib") open_library(text_.rest_of_line());
      if (keyword == "usemtl") use_material(text_.rest_of_line());
      if (!ok) return bad_line(keyword);
      text_.next_line();
    }
    convert_colours();
    finish_materials();
    materials_.give_to(mesh_);
    return std::move(mesh_);
  }

 private:
  bool read_vertex() {
    std::array<float, 4> extra;
    Vec3 p;
    if (!text_.read_number(p.x) || !text_.read_number(p.y) || !text_.read_number(p.z)) return false;
    std::size_t count = 0;
    while (count < extra.size() && text_.read_number(extra[count]))
      ++count;
    mesh_.positions.push_back(p);
    if (count < 3) return true;  // a single fourth number is a weight
    const std::size_t first = count - 3;
    colours_.resize(mesh_.positions.size() - 1, {1, 1, 1});
    colours_.push_back({extra[first], extra[first + 1], extra[first + 2]});
    return true;
  }

  void texture_coordinates() {
    std::array<float, 2> at{};
    if (text_.read_number(at[0])) text_.read_number(at[1]);
    places_.push_back(at);
    mesh_.has_seams = true;
  }

  void open_library(std::string_view name) {
    if (!materials_.open_library(name)) missing_library_ = in_quotes(name);
  }

  void use_material(std::string_view name) {
    if (mesh_.face_count() > 0 && !has_material_) materials_.plain();  // of the faces so far
    has_material_ = true;
    mesh_.use_material(materials_.use(name));
  }

  // A corner is v, v/vt, v//vn or v/vt/vn. Negative numbers count back from the newest vertex.
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
      if (text_.skip('/')) {
        text_.read_number(vt, '/');
        if (text_.skip('/')) text_.word();
      }
      const auto place = place_of(vt);
      if (materials_.has_current()) add_sample(corners_.back(), place);
      if (materials_.has_maps()) at_corners_.push_back(from_upwards(place[0], place[1]));
    }
    is_cut_ = corners_.size() < 3 && text_.is_at_end();
    mesh_.add_face(corners_, text_.line(), at_corners_);
    return !is_cut_;
  }

  // Colours should be 0 to 1, but some programs write 0 to 255.
  void convert_colours() {
    if (colours_.empty()) return;
    colours_.resize(mesh_.positions.size(), {1, 1, 1});
    float largest = 0;
    for (const auto& colour : colours_) {
      for (const float part : colour)
        largest = std::max(largest, part);
    }
    const double scale = largest > 1 ? 1.0 / 255 : 1.0;
    mesh_.attributes.colours.reserve(colours_.size());
    for (const auto& [r, g, b] : colours_) {
      mesh_.attributes.colours.push_back(
          {to_byte(r * scale), to_byte(g * scale), to_byte(b * scale)});
    }
  }

  // Returns the texture coordinate of a corner. `vt` is numbered like v; it is 0 if the corner has
  // no texture coordinate.
  std::array<float, 2> place_of(std::int64_t vt) const {
    const auto count = static_cast<std::int64_t>(places_.size());
    if (vt < 0) vt += count + 1;
    const bool known = vt > 0 && vt <= count;
    return known ? places_[static_cast<std::size_t>(vt - 1)] : std::array<float, 2>{};
  }

  // Adds the material's colour at a corner.
  void add_sample(std::uint32_t vertex, const std::array<float, 2>& place) {
    if (vertex >= mesh_.positions.size()) return;
    means_.resize(mesh_.positions.size());
    means_.add(vertex, materials_.colour_at(place[0], place[1]));
  }

  void finish_materials() {
    if (!means_.empty() && colours_.empty()) {
      means_.resize(mesh_.positions.size());
      mesh_.attributes.colours = means_.take();
      mesh_.is_baked = true;
      mesh_.repairs = materials_.report_baked();
    } else if (!means_.empty()) {
      mesh_.repairs.emplace_back("materials not carried: the vertices have colours of their own");
    } else if (!missing_library_.empty()) {
      mesh_.repairs.push_back("material library " + missing_library_ +
                              " not carried: it is not beside the mesh file");
    } else if (!places_.empty()) {
      mesh_.repairs.emplace_back("texture coordinates not carried");
    }
    const auto unread = materials_.report_unread();
    mesh_.repairs.insert(mesh_.repairs.end(), unread.begin(), unread.end());
  }

  Unexpected bad_line(std::string_view keyword) const {
    const bool vertex = keyword == "v";
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
  std::vector<std::array<float, 3>> colours_;
  std::vector<std::uint32_t> corners_;          // of the face that is read
  std::vector<TextureCoordinates> at_corners_;  // empty if no material has a map
  ObjMaterials materials_;
  std::vector<std::array<float, 2>> places_;  // texture coordinates
  ColourMeans means_;                         // mean material colours; empty if there are none yet
  std::string missing_library_;
  bool has_material_ = false;  // whether `usemtl` was read
  bool is_cut_ = false;        // whether the last line ends before its third corner
};

}  // namespace

bool is_obj(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::string_view, 13> kKeywords{
      "v", "vn", "vt", "vp", "f", "o", "g", "s", "l", "p", "mtllib", "usemtl", "cstype"};
  return std::ranges::count(kKeywords, first_word(bytes)) > 0;
}

Expected<RawMesh> read_obj(std::span<const std::uint8_t> bytes, const ReadOptions& options) {
  return ObjReader(bytes, options).read();
}

}  // namespace vitrine::inline codec
