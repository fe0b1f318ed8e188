// SPDX-License-Identifier: Apache-2.0
#include "codec/import/read_mesh.h"

#include <algorithm>
#include <array>

#include "codec/import/readers.h"
#include "codec/import/text_cursor.h"

namespace vitrine {
namespace {

bool looks_like_obj(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::string_view, 13> kKeywords{
      "v", "vn", "vt", "vp", "f", "o", "g", "s", "l", "p", "mtllib", "usemtl", "cstype"};
  TextCursor text(bytes);
  return text.seek_word() && std::ranges::count(kKeywords, text.word()) > 0;
}

Expected<RawMesh> read_any(std::span<const std::uint8_t> bytes, const Limits&) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (bytes.empty()) return bad_input("the file is empty; copy or export it again");
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) return read_ply(bytes);
  if (looks_like_obj(bytes)) return read_obj(bytes);
  return bad_input("not a mesh file Vitrine reads (PLY, OBJ, STL, OFF, GLB); convert it first");
}

}  // namespace

Expected<ImportedMesh> read_mesh(std::span<const std::uint8_t> bytes, const Limits& limits) {
  auto raw = read_any(bytes, limits);
  if (!raw) return Unexpected(raw.error());
  return std::move(*raw).finish(limits);
}

}  // namespace vitrine
