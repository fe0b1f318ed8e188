// SPDX-License-Identifier: Apache-2.0
// Reads OFF (Geomview): vertices and polygons. The letters of the keyword tell whether the vertices
// have normals and colours.
#include <array>
#include <cmath>

#include "codec/import/readers.h"
#include "codec/import/text_cursor.h"

namespace vitrine::inline codec {
namespace {

bool take_prefix(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

class OffReader {
 public:
  explicit OffReader(std::span<const std::uint8_t> bytes) : text_(bytes) { mesh_.format = "OFF"; }

  Expected<RawMesh> read() {
    if (auto ok = header(); !ok) return tl::unexpected(ok.error());
    mesh_.positions.reserve(vertices_);
    for (std::uint64_t v = 0; v < vertices_; ++v) {
      if (!read_vertex()) return bad("vertex " + std::to_string(v) + " lacks numbers");
    }
    convert_colours();
    mesh_.reserve_faces(faces_);
    for (std::uint64_t f = 0; f < faces_; ++f) {
      if (!read_face()) return bad("face " + std::to_string(f) + " lacks corners");
    }
    return std::move(mesh_);
  }

 private:
  Expected<void> header() {
    text_.seek_word();
    std::string_view name = text_.word();
    const bool textured = take_prefix(name, "ST");
    has_colours_ = take_prefix(name, "C");
    has_normals_ = take_prefix(name, "N");
    if (name != "OFF") {
      return fail(ErrorCode::kUnsupported,
                  "OFF with four or n dimensions is not read; export three dimensions");
    }
    if (textured) mesh_.repairs.emplace_back("texture coordinates not carried");
    double edges = 0;
    if (!text_.seek_word() || !text_.read_number(vertices_)) {
      if (text_.word() == "BINARY") {
        return fail(ErrorCode::kUnsupported, "binary OFF is not read; export it as text or PLY");
      }
      return bad("the number of vertices is missing");
    }
    if (!text_.seek_word() || !text_.read_number(faces_))
      return bad("the number of faces is missing");
    text_.read_number(edges);  // ignored, because it is often wrong or missing
    // A vertex takes at least the six bytes of "0 0 0\n" (five for the last one). A face takes at
    // least two bytes.
    if (vertices_ > text_.left() / 6 + 1 || faces_ > text_.left() / 2 + 1) {
      return bad("the header claims " + std::to_string(vertices_) + " vertices and " +
                 std::to_string(faces_) + " faces, more than the file can hold");
    }
    return {};
  }

  bool read_vertex() {
    Vec3 p;
    if (!text_.seek_word()) return false;
    if (!text_.read_number(p.x) || !text_.read_number(p.y) || !text_.read_number(p.z)) return false;
    mesh_.positions.push_back(p);
    double ignored = 0;
    for (int i = 0; has_normals_ && i < 3; ++i) {
      if (!text_.read_number(ignored)) return false;
    }
    if (!has_colours_) return text_.next_line(), true;
    std::array<float, 3> colour{};
    for (float& part : colour) {
      if (!text_.read_number(part)) return false;
      brightest_ = std::max(brightest_, part);
    }
    colours_.push_back(colour);
    text_.next_line();
    return true;
  }

  // Colours range from 0 to 255 if any component in the file exceeds 1, otherwise from 0 to 1.
  void convert_colours() {
    const double scale = brightest_ > 1 ? 1.0 / 255 : 1.0;
    mesh_.attributes.colours.reserve(colours_.size());
    for (const auto& [r, g, b] : colours_) {
      mesh_.attributes.colours.push_back(
          {to_byte(r * scale), to_byte(g * scale), to_byte(b * scale)});
    }
  }

  bool read_face() {
    std::uint64_t count = 0;
    if (!text_.seek_word() || !text_.read_number(count) || count > text_.left() / 2 + 1)
      return false;
    corners_.resize(count);
    for (std::uint32_t& corner : corners_) {
      if (!text_.read_number(corner)) return false;
    }
    mesh_.add_face(corners_, text_.line());
    text_.next_line();  // the rest of the line is the colour of the face
    return true;
  }

  Unexpected bad(std::string what) const {
    return bad_input("OFF line " + std::to_string(text_.line()) + ": " + std::move(what) +
                     "; the file is cut short or damaged, copy it again");
  }

  TextCursor text_;
  RawMesh mesh_;
  std::uint64_t vertices_ = 0, faces_ = 0;
  bool has_colours_ = false, has_normals_ = false;
  std::vector<std::array<float, 3>> colours_;
  float brightest_ = 0;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

bool is_off_keyword(std::string_view word) {
  return word.size() <= 7 && word.ends_with("OFF") &&
         word.find_first_not_of("STCN4nOF") == word.npos;
}

bool is_off(std::span<const std::uint8_t> bytes) {
  return is_off_keyword(first_word(bytes));
}

Expected<RawMesh> read_off(std::span<const std::uint8_t> bytes, const ReadOptions&) {
  return OffReader(bytes).read();
}

}  // namespace vitrine::inline codec
