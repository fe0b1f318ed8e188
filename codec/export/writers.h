// SPDX-License-Identifier: Apache-2.0
// The functions that write_mesh() calls, one per format. The mesh must have passed the checks of
// write_mesh().
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/export/export_options.h"
#include "codec/export/statements.h"
#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

using FileBytes = std::vector<std::uint8_t>;

// Each function returns the bytes of a file. The file contains `statements` as comments (in STL, in
// its header). `texturing` is either empty or meets the requirements of write_textured_mesh(). The
// names of its pictures are their file names. `normals` is either empty or has one unit vector per
// vertex of the mesh.
FileBytes write_ply(const TriangleMesh& mesh, const Texturing& texturing,
                    std::span<const Vec3> normals, std::span<const Statement> statements);
// `library` is the file name of the material library, which write_obj_library() writes.
FileBytes write_obj(const TriangleMesh& mesh, const Texturing& texturing,
                    std::span<const Vec3> normals, std::string_view library,
                    std::span<const Statement> statements);
FileBytes write_obj_library(const Texturing& texturing);
FileBytes write_stl(const TriangleMesh& mesh, std::span<const Statement> statements);
// `options.unit` must be the unit of the positions in the file, and the error and the grid in
// `options` must be in that unit.
Expected<FileBytes> write_glb(const TriangleMesh& mesh, const Texturing& texturing,
                              std::span<const Vec3> normals, const ExportOptions& options);
FileBytes write_vrml(const TriangleMesh& mesh, const Texturing& texturing,
                     std::span<const Vec3> normals, std::span<const Statement> statements);
// `options` must meet the requirements of write_glb(). 3MF has neither textures nor normals.
Expected<FileBytes> write_3mf(const TriangleMesh& mesh, const ExportOptions& options);
Expected<FileBytes> write_usdz(const TriangleMesh& mesh, const Texturing& texturing,
                               std::span<const Vec3> normals, const ExportOptions& options);

}  // namespace vitrine::inline codec
