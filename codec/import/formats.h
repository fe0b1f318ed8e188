// SPDX-License-Identifier: Apache-2.0
// The table of mesh formats that can be read. All texts that list the formats are generated from
// it, in C++ and in the web client (web/mesh_formats.mjs). `ctest -R lint.formats` checks the
// documents.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "codec/core/fixed_text.h"
#include "codec/import/read_mesh.h"
#include "codec/import/readers.h"
#include "codec/import/unit_comment.h"

namespace vitrine::inline codec {

// A format that can be read. The functions receive `bytes` without a byte order mark.
struct ImportFormat {
  std::string_view name;
  std::string_view extension;
  bool (*recognises)(std::span<const std::uint8_t> bytes);
  Expected<RawMesh> (*read)(std::span<const std::uint8_t> bytes, const ReadOptions& options);
  // returns the unit that the file states, or an empty text
  std::string_view (*unit)(std::span<const std::uint8_t> bytes);
};

// A file is read by the first format that recognises it. Many binary STL files begin with a word,
// so STL precedes the formats that are recognised by their first word.
inline constexpr ImportFormat kImportFormats[] = {
    {.name = "PLY",
     .extension = "ply",
     .recognises = is_ply,
     .read = read_ply,
     .unit = unit_in_comments},
    {.name = "GLB",
     .extension = "glb",
     .recognises = is_glb,
     .read = read_glb,
     .unit = unit_of_gltf},
    {.name = "glTF",
     .extension = "gltf",
     .recognises = is_gltf,
     .read = read_gltf,
     .unit = unit_of_gltf},
    {.name = "STL",
     .extension = "stl",
     .recognises = is_stl,
     .read = read_stl,
     .unit = unit_in_comments},
    {.name = "OFF",
     .extension = "off",
     .recognises = is_off,
     .read = read_off,
     .unit = unit_in_comments},
    {.name = "OBJ",
     .extension = "obj",
     .recognises = is_obj,
     .read = read_obj,
     .unit = unit_in_comments},
};

// The text "PLY, GLB, glTF, STL, OFF or OBJ".
inline constexpr FixedText kImportFormatNames = join(
    kImportFormats, [](const ImportFormat& format) { return format.name; }, ", ", " or ");

}  // namespace vitrine::inline codec
