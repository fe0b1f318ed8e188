// SPDX-License-Identifier: Apache-2.0
// The table of mesh formats that can be read. Lists of the formats in C++ and in the web client
// (web/mesh_formats.mjs) are generated from this table. `ctest -R lint.formats` checks the
// documents.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "codec/core/fixed_text.h"
#include "codec/import/read_mesh.h"
#include "codec/import/readers.h"

namespace vitrine::inline codec {

// A format that can be read. `bytes` never starts with a byte order mark.
struct ImportFormat {
  std::string_view name;
  std::string_view extension;
  bool (*recognises)(std::span<const std::uint8_t> bytes);
  Expected<RawMesh> (*read)(std::span<const std::uint8_t> bytes, const ReadOptions& options);
  // Returns the unit that the file states, or an empty string.
  std::string_view (*unit)(std::span<const std::uint8_t> bytes);
  // If a package or folder has files of one model in several formats, the file with the lowest rank
  // is read. Formats that can store more data have lower ranks.
  unsigned package_rank;
  // Whether modelling programs write the format. Such files often only accompany a model, so they
  // are ignored beside files of other formats.
  bool is_scene = false;
};

// A file is read by the first format that recognises it. STL comes before the formats that are
// recognised by their first word, because many binary STL files begin with such a word. The 3MF row
// reads the XML in a 3MF file, which is a zip package.
inline constexpr ImportFormat kImportFormats[] = {
    {.name = "PLY",
     .extension = "ply",
     .recognises = is_ply,
     .read = read_ply,
     .unit = unit_in_comments,
     .package_rank = 3},
    {.name = "GLB",
     .extension = "glb",
     .recognises = is_glb,
     .read = read_glb,
     .unit = unit_of_gltf,
     .package_rank = 0},
    {.name = "glTF",
     .extension = "gltf",
     .recognises = is_gltf,
     .read = read_gltf,
     .unit = unit_of_gltf,
     .package_rank = 1},
    {.name = "STL",
     .extension = "stl",
     .recognises = is_stl,
     .read = read_stl,
     .unit = unit_in_comments,
     .package_rank = 6},
    {.name = "OFF",
     .extension = "off",
     .recognises = is_off,
     .read = read_off,
     .unit = unit_in_comments,
     .package_rank = 5},
    {.name = "3MF",
     .extension = "3mf",
     .recognises = is_3mf,
     .read = read_3mf,
     .unit = unit_of_3mf,
     .package_rank = 4},
    {.name = "DAE",
     .extension = "dae",
     .recognises = is_dae,
     .read = read_dae,
     .unit = unit_of_dae,
     .package_rank = 8,
     .is_scene = true},
    {.name = "FBX",
     .extension = "fbx",
     .recognises = is_fbx,
     .read = read_fbx,
     .unit = unit_of_fbx,
     .package_rank = 7,
     .is_scene = true},
    {.name = "OBJ",
     .extension = "obj",
     .recognises = is_obj,
     .read = read_obj,
     .unit = unit_in_comments,
     .package_rank = 2},
};

// The text "PLY, GLB, glTF, STL, OFF, 3MF, DAE, FBX or OBJ".
inline constexpr FixedText kImportFormatNames = join(
    kImportFormats, [](const ImportFormat& format) { return format.name; }, ", ", " or ");

}  // namespace vitrine::inline codec
