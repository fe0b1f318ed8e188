// SPDX-License-Identifier: Apache-2.0
// Writes a mesh in one of the common file formats, to memory.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/fixed_text.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// Positions have single precision, except in OBJ and VRML (nine digits) and in DRC (24 bits per
// coordinate of the bounding box).
enum class MeshFormat {
  kPly,   // binary little-endian; colours as bytes
  kGlb,   // glTF 2.0; colours in linear light, as glTF requires, as normalised 16-bit numbers
  kObj,   // colours as three numbers after each position
  kStl,   // binary; stores no colours and does not share vertices
  kDrc,   // Draco edgebreaker; exact colours; Draco reorders vertices and faces
  kVrml,  // VRML 97 with one IndexedFaceSet
};

struct ExportFormat {
  MeshFormat format;
  std::string_view name, extension, media_type;
};

// The table of mesh formats that can be written, in the order of MeshFormat. All texts that list
// the formats are generated from it. `ctest -R lint.formats` checks the texts that cannot be
// generated.
inline constexpr ExportFormat kExportFormats[] = {
    {.format = MeshFormat::kPly,
     .name = "PLY",
     .extension = "ply",
     .media_type = "application/ply"},
    {.format = MeshFormat::kGlb,
     .name = "GLB",
     .extension = "glb",
     .media_type = "model/gltf-binary"},
    {.format = MeshFormat::kObj, .name = "OBJ", .extension = "obj", .media_type = "model/obj"},
    {.format = MeshFormat::kStl, .name = "STL", .extension = "stl", .media_type = "model/stl"},
    {.format = MeshFormat::kDrc,
     .name = "DRC",
     .extension = "drc",
     .media_type = "application/octet-stream"},
    {.format = MeshFormat::kVrml, .name = "VRML", .extension = "wrl", .media_type = "model/vrml"},
};

constexpr const ExportFormat& row_of(MeshFormat format) {
  return kExportFormats[static_cast<std::size_t>(format)];
}

// The three constants below are "ply, glb, obj, stl, drc or wrl", ".ply, .glb, …" and
// "ply,glb,obj,stl,drc,wrl".
constexpr std::string_view extension_of(const ExportFormat& format) {
  return format.extension;
}
inline constexpr FixedText kExportExtensions = join(kExportFormats, extension_of, ", ", " or ");
inline constexpr FixedText kExportSuffixes =
    concatenate(".", join(kExportFormats, extension_of, ", .", ", ."));
inline constexpr FixedText kExportChoice = join(kExportFormats, extension_of, ",", ",");

// Returns the format with this file name extension, in upper or lower case, with or without the
// dot. Returns nullopt if there is none.
std::optional<MeshFormat> format_of_extension(std::string_view extension);

// Returns the bytes of the file. `unit` is the unit of the positions, or empty if it is unknown.
// PLY, OBJ and STL files state the unit in a comment. GLB and VRML require metres, so positions are
// scaled to metres if `unit` is one of kLengthUnits. If the mesh is far from the origin, PLY, OBJ,
// GLB and VRML files keep double precision; STL and DRC files cannot.
//
// Fails with kBadInput if the mesh has no faces or a position does not fit a float. Fails with
// kLimit if the file would exceed the 32-bit sizes of a format.
Expected<std::vector<std::uint8_t>> write_mesh(const TriangleMesh& mesh, MeshFormat format,
                                               std::string_view unit = {});

// Returns a note for the user if the mesh is far from the origin and the format is STL or DRC. The
// note says by how much single precision moves the vertices, in the form "CAUSE; NEXT STEP".
// Returns an empty string for other meshes and formats.
std::string note_on_precision(const TriangleMesh& mesh, MeshFormat format);

}  // namespace vitrine::inline codec
