// SPDX-License-Identifier: Apache-2.0
#include "codec/import/read_mesh.h"

#include <algorithm>
#include <array>

#include "codec/import/readers.h"
#include "codec/import/text_cursor.h"

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

Expected<RawMesh> read_any(std::span<const std::uint8_t> bytes, const Limits& limits) {
  if (bytes.empty()) return bad_input("the file is empty; copy or export it again");
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("glTF")) return read_glb(bytes, limits);
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) return read_ply(bytes);
  // Many binary STL files start with "solid" too, so the size decides before the word.
  if (is_binary_stl(bytes)) return read_stl(bytes);
  const std::string_view word = first_word(bytes);
  if (word == "solid" || word == "SOLID") return read_stl(bytes);
  if (is_off(word)) return read_off(bytes);
  if (is_obj_keyword(word)) return read_obj(bytes);
  return bad_input("not a mesh file Vitrine reads (PLY, OBJ, STL, OFF, GLB); convert it first");
}

}  // namespace

Expected<ImportedMesh> read_mesh(std::span<const std::uint8_t> bytes, const Limits& limits) {
  auto raw = read_any(bytes, limits);
  if (!raw) return Unexpected(raw.error());
  return std::move(*raw).finish(limits);
}

}  // namespace vitrine
