// SPDX-License-Identifier: Apache-2.0
// Reads STL [STL], text or binary. Triangles in STL do not share vertices, so the reader merges
// vertices with equal positions.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "codec/core/byte_cursor.h"
#include "codec/import/readers.h"
#include "codec/import/stated_colours.h"
#include "codec/import/text_cursor.h"
#include "codec/repair/weld.h"

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kHeaderBytes = 84;  // 80 bytes of free text, then the number of facets
constexpr std::size_t kFacetBytes = 50;
constexpr std::size_t kMostFacets = 500'000'000;  // largest credible count
constexpr float kMostUnitNormal = 1.01F;          // largest component of a normal of length 1

std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Facets in file order. Every three consecutive positions are the corners of one facet.
struct Facets {
  std::vector<Vec3> corners;
  // One colour per facet, or kNoColour. Colours of the last facets may be missing.
  std::vector<StatedColour> colours;
  // Number of facets whose attribute bytes are not known to be a colour.
  std::size_t unknown_attributes = 0;

  void paint(const StatedColour& colour) {
    colours.resize(corners.size() / 3, kNoColour);
    if (!colours.empty()) colours.back() = colour;
  }

  // Removes all facets after the first `count`.
  void keep(std::size_t count) {
    corners.resize(3 * count);
    colours.resize(std::min(colours.size(), count));
  }
};

void paint_faces(std::span<const StatedColour> colours, std::span<const std::uint32_t> index,
                 RawMesh& mesh) {
  FaceColours of_faces;
  for (std::size_t f = 0; f < colours.size(); ++f) {
    if (!std::isnan(colours[f][0])) of_faces.add(index.subspan(3 * f, 3), colours[f]);
  }
  of_faces.give_to(mesh);
}

Expected<RawMesh> weld_facets(Facets facets) {
  std::vector<Vec3>& positions = facets.corners;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (is_usable(positions[i])) continue;
    return bad_input("STL facet " + std::to_string(i / 3) +
                     " has a coordinate that is not a finite number (or beyond 1e30); remove it "
                     "and export again");
  }
  RawMesh mesh;
  const std::vector<std::uint32_t> index = weld(positions, mesh.attributes);
  mesh.positions = std::move(positions);
  mesh.reserve_faces(index.size() / 3);
  for (std::size_t i = 0; i + 2 < index.size(); i += 3) {
    mesh.add_triangle({index[i], index[i + 1], index[i + 2]});
  }
  paint_faces(facets.colours, index, mesh);
  if (facets.unknown_attributes > 0)
    mesh.repairs.push_back("attribute bytes of " + counted(facets.unknown_attributes, "facet") +
                           " not carried: nothing in the file says that they are colours; to keep "
                           "colours, export PLY or OBJ");
  return mesh;
}

// Whether `x` is a plausible coordinate. STL exporters write neither infinite nor denormal numbers,
// but bytes of other formats often look like such numbers.
bool is_plausible(float x) {
  return std::abs(x) < 1e30F && std::fpclassify(x) != FP_SUBNORMAL;
}

bool are_plausible_facets(std::span<const std::uint8_t> bytes) {
  ByteReader facets(bytes);
  for (std::size_t f = 0; f < bytes.size() / kFacetBytes; ++f) {
    for (int k = 0; k < 12; ++k) {
      if (!is_plausible(facets.read<float>())) return false;
    }
    facets.skip(2);
  }
  return true;
}

// Whether all facets in the bytes have plausible corners. No component of a normal may exceed
// `most_normal`, and not all bytes may be zero.
bool have_plausible_corners(std::span<const std::uint8_t> bytes, float most_normal) {
  ByteReader facets(bytes);
  for (std::size_t f = 0; f < bytes.size() / kFacetBytes; ++f) {
    for (int k = 0; k < 3; ++k) {
      if (std::abs(facets.read<float>()) > most_normal) return false;  // NaN is allowed
    }
    for (int k = 0; k < 9; ++k) {
      if (!is_plausible(facets.read<float>())) return false;
    }
    facets.skip(2);
  }
  return std::ranges::any_of(bytes, [](std::uint8_t byte) { return byte != 0; });
}

// Whether the bytes after the header are facets, although the stated count and the file's size are
// not credible. Demands at least `fewest` facets. Most facets must have three different corners:
// other data with many zeros looks like facets with equal corners.
bool are_mostly_triangles(std::span<const std::uint8_t> file, std::size_t fewest) {
  constexpr std::size_t kNormalBytes = 12, kCornerBytes = 12;
  const std::size_t count = (file.size() - kHeaderBytes) / kFacetBytes;
  std::size_t triangles = 0;
  for (std::size_t f = 0; f < count; ++f) {
    const auto corner = [&](std::size_t k) {
      return as_text(file.subspan(kHeaderBytes + kFacetBytes * f + kNormalBytes + kCornerBytes * k,
                                  kCornerBytes));
    };
    triangles += corner(0) != corner(1) && corner(1) != corner(2) && corner(2) != corner(0);
  }
  return count >= fewest && triangles > count / 2;
}

// Whether the bytes after the first `known` facets are facets, too. `is_whole`: the file ends with
// the last facet. Normals may then have any length, as some programs write them, if most facets of
// the file are triangles with different corners.
bool are_surplus_facets(std::span<const std::uint8_t> file, std::size_t known, bool is_whole) {
  constexpr std::size_t kFacetsOfASolid = 4;
  const bool are_triangles = are_mostly_triangles(file, kFacetsOfASolid);
  if (known == 0 && !is_whole && !are_triangles) return false;
  const float most_normal =
      is_whole && are_triangles ? std::numeric_limits<float>::infinity() : kMostUnitNormal;
  return have_plausible_corners(file.subspan(kHeaderBytes + kFacetBytes * known), most_normal);
}

std::uint32_t stated_facets(std::span<const std::uint8_t> bytes) {
  return load<std::uint32_t>(&bytes[80]);
}

bool is_control(std::uint8_t byte) {
  return byte < ' ' && (byte < '\t' || byte > '\r');
}

// Whether the file is text. Text starting with "solid" contains no zero byte. Text of another
// format, such as OFF, contains no control character. Binary facets nearly always contain both.
// This check is needed because text can look like plausible binary facets.
bool looks_like_text(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kHeadBytes = 1024;
  const auto head = bytes.first(std::min(bytes.size(), kHeadBytes));
  if (as_text(head.first(5)) != "solid") return std::ranges::none_of(head, is_control);
  return std::ranges::find(head, 0) == head.end();
}

// Returns the number of facets of a binary file, or nullopt if the file is not binary or is
// truncated. Some programs write a wrong count, such as 0, 0xFFFFFFFF or blanks, or one that is too
// small. The number then follows from the file's size, even if some bytes of padding follow the
// facets. If a credible count is too large for the file, the file counts as truncated.
std::optional<std::size_t> binary_facets(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderBytes) return std::nullopt;
  const std::size_t stated = stated_facets(bytes), body = bytes.size() - kHeaderBytes;
  const std::size_t there = body / kFacetBytes;
  const bool is_whole = body % kFacetBytes == 0;
  if (stated == there && is_whole) return stated;
  if (looks_like_text(bytes)) return std::nullopt;
  const bool is_believed = stated > 0 && stated <= kMostFacets;
  if (is_believed && stated > there) return std::nullopt;
  const std::size_t known = is_believed ? stated : 0;
  if (known < there && are_surplus_facets(bytes, known, is_whole)) return there;
  return is_believed ? std::optional(stated) : std::nullopt;
}

// Returns the colour of the whole object. Materialise Magics stores it in the header as "COLOR="
// and four bytes.
std::optional<StatedColour> object_colour(std::span<const std::uint8_t> header) {
  constexpr std::string_view kKeyword = "COLOR=";
  const std::size_t at = as_text(header.first(80)).find(kKeyword);
  if (at > 80 - kKeyword.size() - 4) return std::nullopt;
  const std::uint8_t* bytes = &header[at + kKeyword.size()];
  return StatedColour{bytes[0] / 255.F, bytes[1] / 255.F, bytes[2] / 255.F};
}

// Returns the colour in a facet's last two bytes. They hold five bits per component, and the
// highest bit is a flag. Magics stores red in the lowest bits and sets the flag if the object's
// colour applies. VisCAM and SolidView store blue in the lowest bits and set the flag if the facet
// has a colour.
StatedColour facet_colour(std::uint16_t bits, const std::optional<StatedColour>& of_object) {
  const auto part = [&](int shift) { return static_cast<float>(bits >> shift & 31) / 31; };
  const bool flag = bits >> 15 != 0;
  if (of_object) return flag ? *of_object : StatedColour{part(0), part(5), part(10)};
  return flag ? StatedColour{part(10), part(5), part(0)} : kNoColour;
}

// Reads the colours of the first `count` facets from their attribute bytes.
void read_colours(std::span<const std::uint8_t> bytes, std::size_t count, Facets& out) {
  const auto of_object = object_colour(bytes);
  const auto bits = [&](std::size_t f) {
    return load<std::uint16_t>(&bytes[kHeaderBytes + kFacetBytes * (f + 1) - 2]);
  };
  bool has_bits = false;
  for (std::size_t f = 0; f < count && !has_bits; ++f)
    has_bits = bits(f) != 0;
  if (!has_bits && !of_object) return;
  out.colours.resize(count);
  for (std::size_t f = 0; f < count; ++f) {
    out.colours[f] = has_bits ? facet_colour(bits(f), of_object) : *of_object;
    out.unknown_attributes += bits(f) != 0 && std::isnan(out.colours[f][0]);
  }
}

std::string report_count(std::span<const std::uint8_t> bytes, std::size_t count) {
  const std::size_t rest = bytes.size() - kHeaderBytes - kFacetBytes * count;
  if (const std::size_t stated = stated_facets(bytes); stated != count) {
    const std::string tail = rest == 0 ? "" : ", and " + counted(rest, "byte") + " after them not";
    return counted(count, "facet") + " read by the file's size" + tail +
           ", though its header counts " + std::to_string(stated) +
           (stated > count && stated <= kMostFacets ? "; the file may be cut short: " : "; ") +
           "compare the model with its source";
  }
  if (rest < kFacetBytes) return {};
  return counted(rest, "byte") +
         " after the counted facets are no facets and not read; compare the model with its source";
}

Expected<RawMesh> read_binary(std::span<const std::uint8_t> bytes, std::size_t count) {
  Facets out;
  out.corners.reserve(3 * count);
  ByteReader facets(bytes.subspan(kHeaderBytes));
  for (std::size_t f = 0; f < count; ++f) {
    facets.skip(12);  // the normal; it can be computed from the corners
    for (int k = 0; k < 3; ++k) {
      const double x = facets.read<float>(), y = facets.read<float>(), z = facets.read<float>();
      out.corners.push_back({x, y, z});
    }
    facets.skip(2);
  }
  read_colours(bytes, count, out);
  auto mesh = weld_facets(std::move(out));
  if (const auto line = report_count(bytes, count); mesh && !line.empty())
    mesh->repairs.push_back(line);
  return mesh;
}

class AsciiStl {
 public:
  explicit AsciiStl(std::span<const std::uint8_t> bytes) : text_(bytes) {}

  Expected<RawMesh> read() {
    while (text_.seek_word()) {
      const std::string word = lower_word();
      if (!take(word)) {
        if (text_.has_decimal_comma()) return has_commas();
        if (is_cut_here()) break;
        return bad_input("STL line " + std::to_string(text_.line()) + ": " + in_quotes(word) +
                         " is out of place or lacks numbers; the file is damaged, export it again");
      }
    }
    return is_inside_ ? read_cut() : weld_facets(std::move(facets_));
  }

 private:
  Unexpected has_commas() const {
    return bad_input("STL line " + std::to_string(text_.line()) + ": " +
                     std::string(kDecimalCommas));
  }

  // Whether the text ends with the statement that cannot be read, or with one more word.
  bool is_cut_here() const {
    TextCursor rest = text_;
    const std::string last = lower_case(rest.word());
    return is_inside_ && !last.starts_with("endsolid") && !rest.seek_word();
  }

  // Returns the complete facets of a text without endsolid at its end.
  Expected<RawMesh> read_cut() {
    const std::size_t count = (facets_.corners.size() - static_cast<std::size_t>(corners_)) / 3;
    facets_.keep(count);
    if (count == 0)
      return bad_input("the STL file has no endsolid; it is cut short, copy it again");
    auto mesh = weld_facets(std::move(facets_));
    if (mesh)
      mesh->repairs.push_back(counted(count, "facet") +
                              " read from a text without endsolid at its end; the file may be cut "
                              "short: compare the model with its source");
    return mesh;
  }

  std::string lower_word() { return lower_case(text_.word().substr(0, 12)); }

  // Handles a statement that starts with `word`. Some programs write "end facet" in two words. Some
  // programs write no blank between a word and the name after it.
  bool take(std::string word) {
    if (word == "end") word += lower_word();
    if (word.starts_with(is_inside_ ? "endsolid" : "solid")) {
      is_inside_ = !is_inside_;
      skip_name();
      return corners_ == 0;
    }
    if (!is_inside_) return false;
    if (word == "vertex") return read_vertex();
    if (word == "facet") return skip_normal(), true;
    if (word == "endloop") return std::exchange(corners_, 0) == 3;
    if (word == "endfacet" || word == "color") return read_colour(), true;
    return word == "outerloop" || (word == "outer" && lower_word() == "loop");
  }

  // Skips the rest of the line. If a facet begins on the same line, skips only what precedes it:
  // the name of a solid or, after the end of a solid, also the start of the next one.
  void skip_name() {
    TextCursor facet = text_;
    for (TextCursor next = facet;; facet = next) {
      const std::string word = lower_case(next.word().substr(0, 6));
      if (word.empty()) return text_.next_line();
      TextCursor after = next;
      if (word == "facet" && lower_case(after.word().substr(0, 7)) == "normal") break;
    }
    is_inside_ = true;
    text_ = facet;
  }

  // Skips the word "normal" and its three numbers. The numbers may be invalid: Visual C++ writes
  // 1.#QNAN.
  void skip_normal() {
    for (int i = 0; i < 4 && text_.seek_word(); ++i) {
      TextCursor next = text_;
      if (lower_case(next.word()).starts_with("outer")) return;
      text_ = next;
    }
  }

  // Reads the facet's colour if the line contains a colour.
  void read_colour() {
    StatedColour colour{};
    for (float& part : colour) {
      if (!text_.read_number(part)) return;
    }
    double opacity = 0;
    text_.read_number(opacity);
    facets_.paint(colour);
  }

  bool read_numbers() {
    for (double& part : values_) {
      if (!text_.seek_word() || !text_.read_number(part)) return false;
    }
    return true;
  }

  bool read_vertex() {
    if (corners_ == 3 || !read_numbers()) return false;
    ++corners_;
    facets_.corners.push_back({values_[0], values_[1], values_[2]});
    return true;
  }

  TextCursor text_;
  Facets facets_;
  std::array<double, 3> values_{};
  int corners_ = 0;  // number of corners read in the current loop
  bool is_inside_ = false;
};

// Whether each normal has the length 1 or 0. Bytes of other formats hardly ever look like that.
bool have_unit_normals(std::span<const std::uint8_t> bytes) {
  constexpr float kMostDeviation = 0.03F;
  ByteReader facets(bytes);
  for (std::size_t f = 0; f < bytes.size() / kFacetBytes; ++f) {
    float squares = 0;
    for (int k = 0; k < 3; ++k) {
      const auto part = facets.read<float>();
      squares += part * part;
    }
    if (squares > 0 && std::abs(squares - 1) > kMostDeviation) return false;
    facets.skip(38);
  }
  return true;
}

// Returns the number of facets that a truncated binary STL file still has. Returns nullopt if the
// bytes do not look like binary STL or the first facet is incomplete.
std::optional<std::size_t> facets_of_cut_stl(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderBytes + kFacetBytes) return std::nullopt;
  const std::size_t count = stated_facets(bytes);
  const std::size_t there = (bytes.size() - kHeaderBytes) / kFacetBytes;
  const auto header = bytes.first(kHeaderBytes);
  const bool may_be_text = std::find(header.begin(), header.end(), 0) == header.end();
  if (may_be_text || there >= count) return std::nullopt;
  if (!are_plausible_facets(bytes.subspan(kHeaderBytes))) return std::nullopt;
  return there;
}

// Whether the bytes are a truncated binary STL file beyond doubt.
bool is_cut_stl(std::span<const std::uint8_t> bytes) {
  return facets_of_cut_stl(bytes) && are_mostly_triangles(bytes, 1) &&
         have_unit_normals(bytes.subspan(kHeaderBytes));
}

Expected<RawMesh> read_cut(std::span<const std::uint8_t> bytes, std::size_t there) {
  if (is_cut_stl(bytes)) return read_binary(bytes, there);
  return bad_input("the STL file is cut short: only " + std::to_string(there) + " of " +
                   std::to_string(stated_facets(bytes)) + " triangles are there; copy it again");
}

// Accepts "solid" without a space after it, because some programs write the solid's name directly
// after the word.
bool is_text_stl(std::span<const std::uint8_t> bytes) {
  const std::string word = lower_case(first_word(bytes).substr(0, 6));
  if (word == "solid") return true;
  constexpr std::size_t kHeadBytes = 1024;
  const std::string_view head = as_text(bytes.first(std::min(bytes.size(), kHeadBytes)));
  return word.starts_with("solid") && lower_case(head).find("facet") != head.npos;
}

}  // namespace

bool is_binary_stl(std::span<const std::uint8_t> bytes) {
  return binary_facets(bytes) || is_cut_stl(bytes);
}

bool is_stl(std::span<const std::uint8_t> bytes) {
  return is_binary_stl(bytes) || is_text_stl(bytes);
}

bool may_be_cut_stl(std::span<const std::uint8_t> bytes) {
  return facets_of_cut_stl(bytes).has_value();
}

Expected<RawMesh> read_stl(std::span<const std::uint8_t> bytes, const ReadOptions&) {
  if (const auto count = binary_facets(bytes)) return read_binary(bytes, *count);
  if (const auto there = facets_of_cut_stl(bytes)) return read_cut(bytes, *there);
  return AsciiStl(bytes).read();
}

}  // namespace vitrine::inline codec
