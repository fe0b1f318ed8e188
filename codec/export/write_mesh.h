// SPDX-License-Identifier: Apache-2.0
// Writes a mesh in a common file format. The result is in memory.
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/fixed_text.h"
#include "codec/export/export_options.h"
#include "codec/format/manifest.h"
#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// File formats. Unless the mesh is far from the origin (far_from_origin.h), positions have single
// precision (as text in OBJ, VRML, 3MF and USDZ). DRC instead has 24 bits per coordinate of the
// bounding box.
enum class MeshFormat {
  kPly,   // binary little-endian; a texture as MeshLab writes it, or colours as bytes
  kGlb,   // glTF 2.0; a texture, or colours in linear light; compressed if asked for
  kObj,   // a texture in a material library, or three numbers of a colour after each position
  kStl,   // binary; no colours; each face has its own vertices
  kDrc,   // Draco edgebreaker; exact colours; vertices and faces are reordered
  kVrml,  // VRML 97 with one IndexedFaceSet; a texture or colours
  k3mf,   // a zip for printers, with z up; colours as bytes
  kUsdz,  // an uncompressed zip with a USD layer as text; a texture, or linear colours
};

struct ExportFormat {
  MeshFormat format;
  std::string_view name, extension, media_type;
  // The unit and the up axis that are usual for the format. If `unit` is empty, files have the unit
  // of the model.
  std::string_view unit = {};
  UpAxis up = UpAxis::kY;
  // Whether the format's standard prescribes the unit `unit`, and the axis `up`.
  bool has_fixed_unit = false, has_fixed_up = false;
};

// The table of mesh formats that can be written, in the order of MeshFormat. Lists of the formats
// in texts are generated from this table, or checked against it by `ctest -R lint.formats`.
inline constexpr ExportFormat kExportFormats[] = {
    {.format = MeshFormat::kPly,
     .name = "PLY",
     .extension = "ply",
     .media_type = "application/ply"},
    {.format = MeshFormat::kGlb,
     .name = "GLB",
     .extension = "glb",
     .media_type = "model/gltf-binary",
     .unit = "m",
     .has_fixed_unit = true,
     .has_fixed_up = true},
    {.format = MeshFormat::kObj, .name = "OBJ", .extension = "obj", .media_type = "model/obj"},
    {.format = MeshFormat::kStl,
     .name = "STL",
     .extension = "stl",
     .media_type = "model/stl",
     .unit = "mm",
     .up = UpAxis::kZ},
    {.format = MeshFormat::kDrc,
     .name = "DRC",
     .extension = "drc",
     .media_type = "application/octet-stream"},
    {.format = MeshFormat::kVrml,
     .name = "VRML",
     .extension = "wrl",
     .media_type = "model/vrml",
     .unit = "m",
     .has_fixed_unit = true,
     .has_fixed_up = true},
    {.format = MeshFormat::k3mf,
     .name = "3MF",
     .extension = "3mf",
     .media_type = "model/3mf",
     .unit = "mm",
     .up = UpAxis::kZ,
     .has_fixed_up = true},
    {.format = MeshFormat::kUsdz,
     .name = "USDZ",
     .extension = "usdz",
     .media_type = "model/vnd.usdz+zip",
     .unit = "m"},
};

constexpr const ExportFormat& row_of(MeshFormat format) {
  return kExportFormats[static_cast<std::size_t>(format)];
}

// Each constant below lists all formats: "ply, glb, …, 3mf or usdz", ".ply, .glb, …" and
// "ply,glb,…,3mf,usdz".
constexpr std::string_view extension_of(const ExportFormat& format) {
  return format.extension;
}
inline constexpr FixedText kExportExtensions = join(kExportFormats, extension_of, ", ", " or ");
inline constexpr FixedText kExportSuffixes =
    concatenate(".", join(kExportFormats, extension_of, ", .", ", ."));
inline constexpr FixedText kExportChoice = join(kExportFormats, extension_of, ",", ",");

// Returns the format with this file name extension, or nullopt if there is none. The extension may
// be in upper or lower case, with or without the dot.
std::optional<MeshFormat> format_of_extension(std::string_view extension);

// The picture roles that a format can store, as one bit per PictureRole. OBJ has no standard
// statement for PictureRole::kSurface.
constexpr std::bitset<kPictureRoles> roles_in(MeshFormat format) {
  switch (format) {
    case MeshFormat::kGlb:
    case MeshFormat::kUsdz:
      return 0b1111;
    case MeshFormat::kObj:
      return 0b1011;
    case MeshFormat::kPly:
    case MeshFormat::kVrml:
      return 0b0001;
    default:
      return 0;
  }
}

// Whether a textured mesh in this format has its pictures in files beside the mesh file.
constexpr bool has_companions(MeshFormat format) {
  return format == MeshFormat::kPly || format == MeshFormat::kObj || format == MeshFormat::kVrml;
}

// Returns the bytes of the file. All files but DRC contain the statements of statements.h; STL
// files have room for 80 bytes of them. If the unit is unknown, the files state this, and positions
// are not scaled. If the mesh is far from the origin, files keep double precision, except STL and
// DRC. Smooth normals are computed by unit_normals() (vertex_normals.h). A GLB that is compressed
// or has coarser levels has at most one material.
//
// Fails (kBadInput) if the mesh has no faces, a position does not fit a float, or the options
// contradict the fixed unit and axis of a format. Fails (kLimit) if the file would exceed the
// 32-bit sizes of a format.
Expected<std::vector<std::uint8_t>> write_mesh(const TriangleMesh& mesh, MeshFormat format,
                                               const ExportOptions& options = {});

struct MeshFile {
  std::string name;  // without a folder; ASCII letters, digits, '.', '-' and '_' only
  std::vector<std::uint8_t> bytes;
};

// Returns `name` with `_` instead of each byte that MeshFile::name does not allow. The replaced
// bytes have special meanings in some mesh files, URLs or archives.
std::string plain_name(std::string_view name);

// Returns the files of a mesh with a texture instead of vertex colours. The first file is the mesh,
// STEM.EXTENSION. If the format has companions, the OBJ material library and the pictures follow.
// All names begin with plain_name(stem); the name of a picture file continues with `_` and the
// picture's name in `texturing`.
//
// `texturing` must have one material, whose maps use the first set of coordinates, and pictures in
// JPEG or PNG. For GLB, it may have any number of materials, both sets of coordinates (the first
// one always), and pictures in WebP. The pictures' roles must be in roles_in(format); PLY and VRML
// require a picture of base colours. If the texturing is empty, or the format cannot hold a
// texture, returns one file as write_mesh() does. Fails like write_mesh(), and (kBadInput) if the
// texturing does not fit the mesh or the format.
Expected<std::vector<MeshFile>> write_textured_mesh(const TriangleMesh& mesh, Texturing texturing,
                                                    MeshFormat format, std::string_view stem,
                                                    const ExportOptions& options = {});

// Returns a note for the user if the mesh is far from the origin and the format is STL or DRC. The
// note has the form "CAUSE; NEXT STEP". The note says how far single precision moves the vertices.
// Returns an empty string for other meshes and formats.
std::string note_on_precision(const TriangleMesh& mesh, MeshFormat format);

}  // namespace vitrine::inline codec
