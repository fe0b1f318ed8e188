// SPDX-License-Identifier: Apache-2.0
// Reads STL, text or binary. Triangles in STL do not share vertices, so vertices with equal
// positions are welded.
#include <algorithm>
#include <cmath>
#include <optional>

#include "codec/core/byte_cursor.h"
#include "codec/import/readers.h"
#include "codec/import/text_cursor.h"
#include "codec/repair/weld.h"

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kHeaderBytes = 84;  // 80 bytes of free text, then the number of facets
constexpr std::size_t kFacetBytes = 50;

// Makes a mesh of facets. Every three consecutive positions are the corners of one facet.
Expected<RawMesh> weld_facets(std::vector<Vec3> positions) {
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
  return mesh;
}

// Whether `x` looks like a coordinate. Exporters write neither infinite nor denormal numbers, but
// bytes of other formats often look like them.
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

Expected<RawMesh> read_binary(std::span<const std::uint8_t> bytes, std::uint32_t count) {
  std::vector<Vec3> positions;
  positions.reserve(3 * std::size_t{count});
  ByteReader facets(bytes.subspan(kHeaderBytes));
  for (std::uint32_t f = 0; f < count; ++f) {
    facets.skip(12);  // skips the normal, which follows from the corners
    for (int k = 0; k < 3; ++k) {
      const double x = facets.read<float>(), y = facets.read<float>(), z = facets.read<float>();
      positions.push_back({x, y, z});
    }
    facets.skip(2);
  }
  return weld_facets(std::move(positions));
}

class AsciiStl {
 public:
  explicit AsciiStl(std::span<const std::uint8_t> bytes) : text_(bytes) {}

  Expected<RawMesh> read() {
    while (text_.seek_word()) {
      const std::string word = lower_word();
      if (!take(word)) {
        return bad_input("STL line " + std::to_string(text_.line()) + ": " + in_quotes(word) +
                         " is out of place or lacks numbers; the file is damaged, export it again");
      }
    }
    if (is_inside_)
      return bad_input("the STL file has no endsolid; it is cut short, copy it again");
    return weld_facets(std::move(positions_));
  }

 private:
  std::string lower_word() {
    std::string word(text_.word().substr(0, 12));
    for (char& c : word)
      c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return word;
  }

  bool take(std::string_view word) {
    if (word == "solid" || word == "endsolid") {
      const bool fits = is_inside_ == (word == "endsolid") && corners_ == 0;
      is_inside_ = !is_inside_;
      text_.next_line();
      return fits;
    }
    if (!is_inside_) return false;
    if (word == "vertex") return read_vertex();
    if (word == "facet") return lower_word() == "normal" && read_numbers();
    if (word == "endloop") return std::exchange(corners_, 0) == 3;
    return word == "outer" ? lower_word() == "loop" : word == "endfacet";
  }

  bool read_numbers() {
    for (double& part : values_) {
      if (!text_.seek_word() || !text_.read_number(part)) return false;
    }
    return true;
  }

  bool read_vertex() {
    if (corners_++ == 3 || !read_numbers()) return false;
    positions_.push_back({values_[0], values_[1], values_[2]});
    return true;
  }

  TextCursor text_;
  std::vector<Vec3> positions_;
  std::array<double, 3> values_{};
  int corners_ = 0;  // corners of the current loop so far
  bool is_inside_ = false;
};

// Returns how much of a truncated binary STL file exists, such as "3 of 12 triangles". Returns
// nullopt if the bytes do not look like binary STL or the first triangle is incomplete.
std::optional<std::string> facets_of_cut_stl(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderBytes + kFacetBytes) return std::nullopt;
  const std::size_t count = load<std::uint32_t>(&bytes[80]);
  const std::size_t there = (bytes.size() - kHeaderBytes) / kFacetBytes;
  const auto header = bytes.first(kHeaderBytes);
  const bool may_be_text = std::find(header.begin(), header.end(), 0) == header.end();
  if (may_be_text || there >= count) return std::nullopt;
  if (!are_plausible_facets(bytes.subspan(kHeaderBytes))) return std::nullopt;
  return std::to_string(there) + " of " + std::to_string(count) + " triangles";
}

}  // namespace

bool is_binary_stl(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderBytes) return false;
  const std::size_t size = kHeaderBytes + kFacetBytes * load<std::uint32_t>(&bytes[80]);
  // Text has no zero byte. The facet count of a binary file nearly always has one.
  const auto header = bytes.first(kHeaderBytes);
  const bool may_be_text = std::equal(header.begin(), header.begin() + 5, "solid") &&
                           std::find(header.begin(), header.end(), 0) == header.end();
  return size == bytes.size() || (!may_be_text && size > kHeaderBytes && size < bytes.size());
}

bool is_stl(std::span<const std::uint8_t> bytes) {
  const std::string_view word = first_word(bytes);
  return is_binary_stl(bytes) || facets_of_cut_stl(bytes) || word == "solid" || word == "Solid" ||
         word == "SOLID";
}

Expected<RawMesh> read_stl(std::span<const std::uint8_t> bytes, const ReadOptions&) {
  if (is_binary_stl(bytes)) return read_binary(bytes, load<std::uint32_t>(&bytes[80]));
  if (const auto there = facets_of_cut_stl(bytes)) {
    return bad_input("the STL file is cut short: only " + *there + " are there; copy it again");
  }
  return AsciiStl(bytes).read();
}

}  // namespace vitrine::inline codec
