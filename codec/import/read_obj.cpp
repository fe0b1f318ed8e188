// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ: vertices (with the common r g b extension) and polygons.
#include <algorithm>

#include "codec/import/readers.h"
#include "codec/import/text_cursor.h"

namespace vitrine {
namespace {

class ObjReader {
 public:
  explicit ObjReader(std::span<const std::uint8_t> bytes) : text_(bytes) {}

  Expected<RawMesh> read() {
    while (text_.seek_word()) {
      const std::string_view keyword = text_.word();
      bool ok = true;
      if (keyword == "v") ok = vertex();
      if (keyword == "f") ok = face();
      if (keyword == "vt") has_texture_coordinates_ = true;
      if (keyword == "mtllib") library_ = in_quotes(text_.rest_of_line());
      if (!ok) return bad_line(keyword);
      text_.next_line();
    }
    convert_colours();
    name_textures();
    return std::move(mesh_);
  }

 private:
  bool vertex() {
    std::array<float, 4> extra;
    Vec3 p;
    if (!text_.number(p.x) || !text_.number(p.y) || !text_.number(p.z)) return false;
    std::size_t count = 0;
    while (count < extra.size() && text_.number(extra[count]))
      ++count;
    mesh_.positions.push_back(p);
    if (count < 3) return true;  // a fourth number alone is a weight
    const std::size_t first = count - 3;
    colours_.resize(mesh_.positions.size() - 1, {1, 1, 1});
    colours_.push_back({extra[first], extra[first + 1], extra[first + 2]});
    return true;
  }

  // Corners are v, v/vt, v//vn or v/vt/vn; negative numbers count back from the newest vertex.
  bool face() {
    corners_.clear();
    while (!text_.line_is_done()) {
      std::int64_t v = 0;
      if (!text_.number(v, '/')) return false;
      if (v < 0) v += static_cast<std::int64_t>(mesh_.positions.size()) + 1;
      if (v <= 0) return false;
      corners_.push_back(static_cast<std::uint32_t>(std::min<std::int64_t>(v - 1, 0xFFFF'FFFF)));
      if (text_.skip('/')) text_.word();
    }
    mesh_.add_face(corners_);
    return true;
  }

  // Colours are 0..1, but some programs write 0..255.
  void convert_colours() {
    if (colours_.empty()) return;
    colours_.resize(mesh_.positions.size(), {1, 1, 1});
    float largest = 0;
    for (const auto& colour : colours_) {
      for (const float part : colour)
        largest = std::max(largest, part);
    }
    const double scale = largest > 1 ? 1.0 / 255 : 1.0;
    mesh_.colours.reserve(colours_.size());
    for (const auto& [r, g, b] : colours_) {
      mesh_.colours.push_back({to_byte(r * scale), to_byte(g * scale), to_byte(b * scale)});
    }
  }

  void name_textures() {
    if (!has_texture_coordinates_) return;
    mesh_.repairs.push_back(library_.empty()
                                ? "texture coordinates not carried"
                                : "texture map (material library " + library_ + ") not carried");
  }

  Unexpected bad_line(std::string_view keyword) const {
    const bool vertex = keyword == "v";
    return bad_input("OBJ line " + std::to_string(text_.line()) +
                     (vertex ? ": a vertex needs three numbers"
                             : ": a face needs vertex numbers from 1, or from -1 back to the first "
                               "vertex") +
                     "; correct the line or export the file again");
  }

  TextCursor text_;
  RawMesh mesh_;
  std::vector<std::array<float, 3>> colours_;
  std::vector<std::uint32_t> corners_;
  std::string library_;
  bool has_texture_coordinates_ = false;
};

}  // namespace

Expected<RawMesh> read_obj(std::span<const std::uint8_t> bytes) {
  return ObjReader(bytes).read();
}

}  // namespace vitrine
