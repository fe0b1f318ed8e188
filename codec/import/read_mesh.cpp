// SPDX-License-Identifier: Apache-2.0
#include "codec/import/read_mesh.h"

#include <algorithm>
#include <array>

#include "codec/import/readers.h"
#include "codec/import/text_cursor.h"
#include "codec/import/unit_comment.h"

namespace vitrine {
namespace {

bool is_obj_keyword(std::string_view word) {
  constexpr std::array<std::string_view, 13> kKeywords{
      "v", "vn", "vt", "vp", "f", "o", "g", "s", "l", "p", "mtllib", "usemtl", "cstype"};
  return std::ranges::count(kKeywords, word) > 0;
}

std::string_view first_word(std::span<const std::uint8_t> bytes) {
  TextCursor text(bytes);
  return text.seek_word() ? text.word() : std::string_view{};
}

bool is_glb(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kMagic = "glTF";
  return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

Expected<RawMesh> read_any(std::span<const std::uint8_t> bytes, const ReadOptions& options) {
  if (bytes.empty()) return bad_input("the file is empty; copy or export it again");
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (is_glb(bytes)) return read_glb(bytes, options.limits);
  if (text.starts_with("ply\n") || text.starts_with("ply\r"))
    return read_ply(bytes, options.beside);
  // Many binary STL files start with "solid" too, so the size decides before the word.
  if (is_binary_stl(bytes)) return read_stl(bytes);
  if (const auto there = facets_of_cut_stl(bytes)) {
    return bad_input("the STL file is cut short: only " + *there + " are there; copy it again");
  }
  const std::string_view word = first_word(bytes);
  if (word == "solid" || word == "Solid" || word == "SOLID") return read_stl(bytes);
  if (is_off(word)) return read_off(bytes);
  if (is_obj_keyword(word)) return read_obj(bytes, options.beside);
  return bad_input("not a mesh file Vitrine reads (PLY, OBJ, STL, OFF, GLB); convert it first");
}

// Some editors begin a text with the byte order mark of UTF-8.
std::span<const std::uint8_t> without_mark(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::uint8_t, 3> kMark{0xEF, 0xBB, 0xBF};
  const bool marked =
      bytes.size() > kMark.size() && std::equal(kMark.begin(), kMark.end(), bytes.begin());
  return marked ? bytes.subspan(kMark.size()) : bytes;
}

// A quarter turn about x: exact, and it keeps the handedness.
void turn_z_up_to_y(std::vector<Vec3>& positions) {
  for (Vec3& p : positions)
    p = {p.x, p.z, -p.y};
}

}  // namespace

std::string_view stated_unit(std::span<const std::uint8_t> file) {
  const auto bytes = without_mark(file);
  return is_glb(bytes) ? "m" : unit_in_comments(bytes);
}

Expected<ImportedMesh> read_mesh(std::span<const std::uint8_t> file, const ReadOptions& options) {
  const auto bytes = without_mark(file);
  auto raw = read_any(bytes, options);
  if (!raw) return Unexpected(raw.error());
  auto imported = std::move(*raw).finish(options.limits);
  if (!imported) return imported;
  imported->unit = options.unit.empty() ? stated_unit(file) : options.unit;
  if (options.up == UpAxis::kZ) turn_z_up_to_y(imported->mesh.positions);
  return imported;
}

}  // namespace vitrine
