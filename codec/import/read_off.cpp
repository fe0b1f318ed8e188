// SPDX-License-Identifier: Apache-2.0
// Reads OFF, the format of Geomview [OFF]: vertices and polygons. The letters in the keyword say
// whether vertices have normals and colours.
#include <algorithm>
#include <array>
#include <optional>

#include "codec/import/readers.h"
#include "codec/import/stated_colours.h"
#include "codec/import/text_cursor.h"

namespace vitrine::inline codec {
namespace {

// The keyword of a file: letters that say what each vertex has, followed by "OFF".
struct OffKeyword {
  std::size_t size = 0;  // length of the keyword in bytes; 0 if the file has none
  bool has_colours = false, has_normals = false, has_coordinates = false;
  bool has_more_dimensions = false;
  // Whether the colour of a vertex precedes its normal. Geomview writes the keyword letters in the
  // order STCN, and normals before colours. Programs that write N before C, such as MeshLab, write
  // colours before normals.
  bool colours_come_first = false;
};

bool starts_with_digit(std::string_view text) {
  return !text.empty() && text[0] >= '0' && text[0] <= '9';
}

// Returns the keyword at the start of a word. The number of vertices may follow directly, without a
// blank.
std::optional<OffKeyword> off_keyword(std::string_view word) {
  constexpr std::size_t kMostLetters = 6;
  const std::string lower = lower_case(word.substr(0, kMostLetters + 3));
  const std::size_t end = lower.find("off");
  if (end == lower.npos || end > kMostLetters) return std::nullopt;
  OffKeyword out{.size = end + 3};
  const std::string_view after = word.substr(out.size);
  if (!after.empty() && !starts_with_digit(after)) return std::nullopt;
  for (std::size_t i = 0; i < end; ++i) {
    const bool is_dimension = word[i] == '4' || (word[i] == 'n' && word[end] == 'O');
    if (is_dimension) {
      out.has_more_dimensions = true;
    } else if (lower[i] == 'c') {
      out.has_colours = true;
      out.colours_come_first = out.has_normals;
    } else if (lower[i] == 'n') {
      out.has_normals = true;
    } else if (lower.compare(i, 2, "st") == 0) {
      out.has_coordinates = true;
      ++i;
    } else {
      return std::nullopt;
    }
  }
  return out;
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
    take_colours();
    mesh_.reserve_faces(faces_);
    for (std::uint64_t f = 0; f < faces_; ++f) {
      if (!read_face()) return bad("face " + std::to_string(f) + " lacks corners");
    }
    face_colours_.give_to(mesh_);
    report_numbered_colours();
    return std::move(mesh_);
  }

 private:
  Expected<void> header() {
    read_keyword();
    if (keyword_.has_more_dimensions) {
      return fail(ErrorCode::kUnsupported,
                  "OFF with four or n dimensions is not read; export three dimensions");
    }
    double edges = 0;
    if (!text_.seek_word() || !text_.read_number(vertices_)) {
      if (text_.word() == "BINARY") {
        return fail(ErrorCode::kUnsupported, "binary OFF is not read; export it as text or PLY");
      }
      return bad("the number of vertices is missing");
    }
    if (!text_.seek_word() || !text_.read_number(faces_))
      return bad("the number of faces is missing");
    text_.read_number(edges);  // the value is ignored: it is often wrong or missing
    if (keyword_.has_coordinates)
      mesh_.repairs.push_back(counted(vertices_, "texture coordinate") +
                              " not carried; OFF names no picture, so export the mesh as GLB");
    // A vertex takes at least the six bytes of "0 0 0\n", or five at the end of the file. A face
    // takes at least two bytes.
    if (vertices_ > text_.left() / 6 + 1 || faces_ > text_.left() / 2 + 1) {
      return bad("the header claims " + std::to_string(vertices_) + " vertices and " +
                 std::to_string(faces_) + " faces, more than the file can hold");
    }
    return {};
  }

  void read_keyword() {
    text_.seek_word();
    const std::string_view word = TextCursor(text_).word();
    keyword_ = off_keyword(word).value_or(OffKeyword{});
    for (const char c : word.substr(0, keyword_.size))
      text_.skip(c);
  }

  bool read_vertex() {
    Vec3 p;
    if (!text_.seek_word()) return false;
    if (!text_.read_number(p.x) || !text_.read_number(p.y) || !text_.read_number(p.z)) return false;
    mesh_.positions.push_back(p);
    if (!take_extra(read_extra())) return false;
    text_.next_line();
    return true;
  }

  // Reads the remaining numbers on the line into `extra_` and returns how many there are.
  std::size_t read_extra() {
    std::size_t count = 0;
    while (count < extra_.size() && text_.read_number(extra_[count]))
      ++count;
    return count;
  }

  // Finds the vertex colour among the numbers after a vertex's coordinates. Returns false if the
  // line has too few numbers.
  bool take_extra(std::size_t count) {
    const std::size_t coordinates = keyword_.has_coordinates ? 2 : 0;
    std::size_t normals = keyword_.has_normals ? 3 : 0;
    const bool wants_colour = keyword_.has_colours;
    // MeshLab writes N in the keyword even if the vertices have no normals.
    if (wants_colour && count == coordinates + 4) normals = 0;
    const std::size_t others = coordinates + normals;
    if (count < others + (wants_colour ? 3 : 0)) return count == 0 && !wants_colour && normals == 0;
    if (count < others + 3) return true;
    const std::size_t begin = keyword_.colours_come_first ? 0 : normals;
    colours_.resize(mesh_.positions.size() - 1, kNoColour);
    colours_.push_back({extra_[begin], extra_[begin + 1], extra_[begin + 2]});
    if (count >= others + 4) mesh_.translucent_colours += is_translucent(extra_[begin + 3]);
    return true;
  }

  // Sets the colours of the vertices. If the keyword has no C, negative numbers mean that the
  // numbers after the coordinates are not colours.
  void take_colours() {
    if (colours_.empty()) return;
    const auto is_negative = [](const StatedColour& colour) {
      return std::ranges::any_of(colour, [](float part) { return part < 0; });
    };
    if (!keyword_.has_colours && std::ranges::any_of(colours_, is_negative)) {
      mesh_.repairs.push_back(
          "numbers after the coordinates of " + counted(colours_.size(), "line") +
          " not carried: they are no colours; name them in the keyword, such as NOFF");
      mesh_.translucent_colours = 0;
      return;
    }
    colours_.resize(mesh_.positions.size(), kNoColour);
    mesh_.attributes.colours = to_colours(colours_, mesh_.repairs);
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
    const std::size_t extra = read_extra();
    if (extra >= 3) face_colours_.add(corners_, {extra_[0], extra_[1], extra_[2]});
    if (extra >= 4) mesh_.translucent_colours += is_translucent(extra_[3]);
    numbered_colours_ += extra == 1;
    text_.next_line();
    return true;
  }

  void report_numbered_colours() {
    if (numbered_colours_ == 0) return;
    mesh_.repairs.push_back("colours of " + counted(numbered_colours_, "face") +
                            " not carried: they are numbers of a colour map; write red, green and "
                            "blue");
  }

  Unexpected bad(std::string what) const {
    if (text_.has_decimal_comma())
      what = kDecimalCommas;
    else
      what += "; the file is cut short or damaged, copy it again";
    return bad_input("OFF line " + std::to_string(text_.line()) + ": " + what);
  }

  TextCursor text_;
  RawMesh mesh_;
  std::uint64_t vertices_ = 0, faces_ = 0;
  OffKeyword keyword_;
  std::array<float, 10> extra_{};  // numbers after the coordinates or corners on a line
  std::vector<StatedColour> colours_;
  FaceColours face_colours_;
  std::uint64_t numbered_colours_ = 0;
  std::vector<std::uint32_t> corners_;
};

// Whether the bytes are an OFF file without a keyword, which Geomview allows. Such a file has three
// counts, the vertices, and a first face with at least three corners.
bool is_bare_off(std::span<const std::uint8_t> bytes) {
  TextCursor text(bytes);
  std::uint64_t vertices = 0, faces = 0, edges = 0, corners = 0, corner = 0;
  if (!text.seek_word() || !text.read_number(vertices) || !text.read_number(faces) ||
      !text.read_number(edges) || !text.line_is_done())
    return false;
  if (vertices < 3 || vertices > text.left() / 6 + 1 || faces == 0) return false;
  for (std::uint64_t v = 0; v < vertices; ++v, text.next_line()) {
    double number = 0;
    if (!text.seek_word() || !text.read_number(number)) return false;
    if (!text.read_number(number) || !text.read_number(number)) return false;
  }
  if (!text.seek_word() || !text.read_number(corners) || corners < 3) return false;
  for (std::uint64_t c = 0; c < corners; ++c) {
    if (!text.read_number(corner) || corner >= vertices) return false;
  }
  return true;
}

}  // namespace

bool is_off_keyword(std::string_view word) {
  const auto keyword = off_keyword(word);
  return keyword && keyword->size == word.size();
}

bool is_off(std::span<const std::uint8_t> bytes) {
  return off_keyword(first_word(bytes)) || is_bare_off(bytes);
}

Expected<RawMesh> read_off(std::span<const std::uint8_t> bytes, const ReadOptions&) {
  return OffReader(bytes).read();
}

}  // namespace vitrine::inline codec
