// SPDX-License-Identifier: Apache-2.0
// The readers of the formats, which read_mesh() calls; one file per format. They are safe on
// untrusted bytes, except for Draco data, pictures and FBX (see read_mesh.h).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "codec/core/expected.h"
#include "codec/import/read_mesh.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {

Expected<RawMesh> read_ply(std::span<const std::uint8_t> bytes, const ReadOptions& options);
Expected<RawMesh> read_obj(std::span<const std::uint8_t> bytes, const ReadOptions& options);
Expected<RawMesh> read_stl(std::span<const std::uint8_t> bytes, const ReadOptions& options);
Expected<RawMesh> read_off(std::span<const std::uint8_t> bytes, const ReadOptions& options);
Expected<RawMesh> read_glb(std::span<const std::uint8_t> bytes, const ReadOptions& options);
Expected<RawMesh> read_3mf(std::span<const std::uint8_t> bytes, const ReadOptions& options);
Expected<RawMesh> read_dae(std::span<const std::uint8_t> bytes, const ReadOptions& options);
Expected<RawMesh> read_fbx(std::span<const std::uint8_t> bytes, const ReadOptions& options);
Expected<RawMesh> read_gltf(std::span<const std::uint8_t> bytes, const ReadOptions& options);

// Removes a UTF-8 byte order mark. Some editors write it at the start of a text file.
std::span<const std::uint8_t> without_mark(std::span<const std::uint8_t> bytes);

// Each function returns whether the bytes begin like a file of its format.
bool is_ply(std::span<const std::uint8_t> bytes);
bool is_obj(std::span<const std::uint8_t> bytes);
bool is_stl(std::span<const std::uint8_t> bytes);
bool is_off(std::span<const std::uint8_t> bytes);
bool is_glb(std::span<const std::uint8_t> bytes);
bool is_gltf(std::span<const std::uint8_t> bytes);
bool is_3mf(std::span<const std::uint8_t> bytes);
bool is_dae(std::span<const std::uint8_t> bytes);
bool is_fbx(std::span<const std::uint8_t> bytes);

bool is_binary_stl(std::span<const std::uint8_t> bytes);
// Whether the bytes may be a truncated binary STL file, although is_stl() does not recognise them.
// read_stl() then returns an error that tells how much is there.
bool may_be_cut_stl(std::span<const std::uint8_t> bytes);
bool is_off_keyword(std::string_view word);

// Each function returns the unit of the mesh that the reader of its format returns.
std::string_view unit_of_3mf(std::span<const std::uint8_t> bytes);
std::string_view unit_of_dae(std::span<const std::uint8_t> bytes);
std::string_view unit_of_fbx(std::span<const std::uint8_t> bytes);

// Returns the unit that a comment states: "mm", "cm", "m" or "in". The comment must be at the start
// of the file: in the first 64 KB, and before the first line of data. Examples of comments are
// "comment unit mm", "# Units: millimeters" and "UNITS=mm". The file may be PLY, OBJ, STL
// or OFF. Returns an empty string if no comment states a unit.
std::string_view unit_in_comments(std::span<const std::uint8_t> file);

// Returns "m", because the glTF standard requires metres.
std::string_view unit_of_gltf(std::span<const std::uint8_t> bytes);

}  // namespace vitrine::inline codec
