// SPDX-License-Identifier: Apache-2.0
#include "codec/export/write_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "codec/export/far_from_origin.h"
#include "codec/export/write_drc.h"
#include "codec/export/writers.h"
#include "codec/mesh/unit.h"
#include "codec/mesh/vertex_normals.h"

namespace vitrine::inline codec {
namespace {

// GLB and STL store sizes as 32-bit byte counts. In STL, a face takes 50 bytes. In GLB, a face
// takes 12 bytes and a vertex up to 32. A textured face has up to three vertices of its own.
constexpr std::size_t kMostFaces = 80'000'000, kMostTexturedFaces = 30'000'000;

bool fits_float(const Vec3& p) {
  constexpr double kMost = std::numeric_limits<float>::max();
  return std::abs(p.x) <= kMost && std::abs(p.y) <= kMost && std::abs(p.z) <= kMost;
}

Expected<void> check(const TriangleMesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  if (mesh.faces.empty())
    return fail(ErrorCode::kBadInput, "there are no faces to write; ask for a finer level");
  if (mesh.faces.size() > kMostFaces || vertices > 100'000'000) {
    return fail(ErrorCode::kLimit, "the mesh is too large to export; ask for fewer triangles");
  }
  if (!mesh.attributes.fit(vertices)) {
    return fail(ErrorCode::kBadInput,
                "an attribute of the mesh has another number of values than there are vertices; "
                "give one value per vertex, or none");
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    if (!fits_float(mesh.positions[v])) {
      return fail(ErrorCode::kBadInput,
                  "the position of vertex " + std::to_string(v) +
                      " is too large for a single-precision number; scale the scan down");
    }
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (std::ranges::max(mesh.faces[f]) >= vertices) {
      return fail(ErrorCode::kBadInput, "face " + std::to_string(f) +
                                            " has a vertex index out of range; export it again");
    }
  }
  return {};
}

Expected<void> check(const TriangleMesh& mesh, const Texturing& texturing, MeshFormat format) {
  if (texturing.empty()) return {};
  const bool needs_base_colours = format == MeshFormat::kPly || format == MeshFormat::kVrml;
  const bool is_glb = format == MeshFormat::kGlb;
  bool is_good = (is_glb || texturing.materials.size() == 1) &&
                 texturing.coordinates[0].size() == mesh.faces.size() &&
                 texturing.face_materials.size() == mesh.faces.size() &&
                 (texturing.coordinates[1].empty() ||
                  (is_glb && texturing.coordinates[1].size() == mesh.faces.size())) &&
                 (!needs_base_colours || texturing.materials.front().base_colour_map.has_value());
  std::uint64_t bytes = 0;
  for (const EncodedPicture& picture : texturing.pictures)
    bytes += picture.bytes.size();
  for (const Material& material : texturing.materials) {
    for_each_map(material, [&](const TextureMap& map) {
      is_good = is_good && map.coordinates < kCoordinateSets &&
                !texturing.coordinates[map.coordinates].empty() &&
                map.picture < texturing.pictures.size();
    });
  }
  for (const std::uint16_t material : texturing.face_materials)
    is_good = is_good && material < texturing.materials.size();
  if (!is_good) {
    return fail(ErrorCode::kBadInput,
                "the texture does not fit the mesh or the format; give one material with a base "
                "colour map, and texture coordinates for each face");
  }
  if (bytes > 1'000'000'000)
    return fail(ErrorCode::kLimit, "the pictures are too large to export; ask for smaller ones");
  if (mesh.faces.size() > kMostTexturedFaces) {
    return fail(ErrorCode::kLimit,
                "the textured mesh is too large to export; ask for fewer triangles");
  }
  return {};
}

Expected<void> check(MeshFormat format, const ExportOptions& options) {
  const ExportFormat& row = row_of(format);
  if (options.compression != Compression::kNone && format != MeshFormat::kGlb)
    return fail(ErrorCode::kBadInput, "only GLB files can be compressed; choose GLB");
  const bool is_other_unit = !options.unit_in_file.empty() && options.unit_in_file != row.unit;
  const auto demand = [&](std::string_view frame) {
    return fail(ErrorCode::kBadInput, std::string(row.name) + " files have " + std::string(frame) +
                                          "; choose this, or another format");
  };
  if (row.has_fixed_unit && is_other_unit) return demand("the unit " + std::string(row.unit));
  if (row.has_fixed_up && options.up.value_or(row.up) != row.up)
    return demand(std::string(name_of(row.up)) + " up");
  return {};
}

// Checks the coarser levels of a file. `texturing` is the texturing of the finest mesh.
Expected<void> check(const TriangleMesh& finest, const Texturing& texturing, MeshFormat format,
                     std::span<const CoarserLevel> coarser) {
  if (coarser.empty()) return {};
  if (format != MeshFormat::kGlb)
    return fail(ErrorCode::kBadInput, "only GLB files hold several levels of detail; choose GLB");
  if (texturing.materials.size() > 1) {
    return fail(ErrorCode::kUnsupported,
                "a GLB with several levels of detail has one material; write a single level");
  }
  std::size_t faces = finest.faces.size();
  for (const CoarserLevel& level : coarser) {
    if (auto ok = check(level.mesh); !ok) return ok;
    faces += level.mesh.faces.size();
    if (level.coordinates.size() != (texturing.empty() ? 0 : level.mesh.faces.size())) {
      return fail(ErrorCode::kBadInput,
                  "the texture does not fit level " + std::to_string(level.level) +
                      "; give texture coordinates for each face if the finest mesh has a texture");
    }
  }
  if (faces > (texturing.empty() ? kMostFaces : kMostTexturedFaces)) {
    return fail(ErrorCode::kLimit,
                "the levels of detail are too large together; ask for fewer triangles");
  }
  return {};
}

// Returns the options that describe the file: its positions' unit, the error in that unit, and the
// axis that points up. Sets `factor`, by which the positions of the mesh must be multiplied.
ExportOptions options_of_file(MeshFormat format, const ExportOptions& options, double& factor) {
  ExportOptions file = options;
  const auto metres = metres_per(options.unit);
  const ExportFormat& row = row_of(format);
  const std::string_view wanted = row.has_fixed_unit ? row.unit : options.unit_in_file;
  const auto metres_in_file = metres_per(wanted);
  factor = metres && metres_in_file ? *metres / *metres_in_file : 1;
  if (metres && metres_in_file) file.unit = wanted;
  if (!metres && row.has_fixed_unit) file.unit = {};
  if (row.has_fixed_up) file.up = row.up;
  if (file.about.error) *file.about.error *= factor;
  if (file.grid) file.grid = ExportGrid{file.grid->origin * factor, file.grid->step * factor};
  return file;
}

// Multiplies the positions by `factor`. If `has_z_up`, also rotates positions and normals from y up
// to z up.
void place(TriangleMesh& mesh, std::vector<Vec3>& normals, double factor, bool has_z_up) {
  for (Vec3& p : mesh.positions)
    p = has_z_up ? turn_y_up_to_z(p * factor) : p * factor;
  if (!has_z_up) return;
  for (Vec3& n : normals)
    n = turn_y_up_to_z(n);
}

// Writes a mesh that already has the unit and the axes of the file. `library` is the name of the
// OBJ material library.
Expected<FileBytes> placed_file(const TriangleMesh& mesh, const Texturing& texturing,
                                std::span<const Vec3> normals, MeshFormat format,
                                std::string_view library, const ExportOptions& options) {
  const std::vector<Statement> statements = statements_of(options);
  switch (format) {
    case MeshFormat::kPly:
      return write_ply(mesh, texturing, normals, statements);
    case MeshFormat::kGlb:
      return write_glb(mesh, texturing, normals, options);
    case MeshFormat::kObj:
      return write_obj(mesh, texturing, normals, library, statements);
    case MeshFormat::kStl:
      return write_stl(mesh, statements);
    case MeshFormat::kDrc:
      return write_drc(mesh);
    case MeshFormat::kVrml:
      return write_vrml(mesh, texturing, normals, statements);
    case MeshFormat::k3mf:
      return write_3mf(mesh, options);
    case MeshFormat::kUsdz:
      return write_usdz(mesh, texturing, normals, options);
  }
  return fail(ErrorCode::kUnsupported,
              "unknown mesh format; choose " + std::string(kExportExtensions));
}

// Returns the coarser levels in the unit of the file.
std::vector<CoarserLevel> placed_levels(std::span<const CoarserLevel> levels, double factor) {
  std::vector<CoarserLevel> placed(levels.begin(), levels.end());
  for (CoarserLevel& level : placed) {
    for (Vec3& p : level.mesh.positions)
      p = p * factor;
    level.error *= factor;
    level.grid = {level.grid.origin * factor, level.grid.step * factor};
  }
  return placed;
}

// Whether a format holds the normals of vertices.
bool has_normals(MeshFormat format) {
  return format != MeshFormat::kStl && format != MeshFormat::kDrc && format != MeshFormat::k3mf;
}

Expected<FileBytes> mesh_file(const TriangleMesh& mesh, const Texturing& texturing,
                              MeshFormat format, std::string_view library,
                              const ExportOptions& options) {
  const bool is_smooth = options.normals == Normals::kSmooth && has_normals(format);
  std::vector<Vec3> normals = is_smooth ? unit_normals(mesh) : std::vector<Vec3>();
  double factor = 1;
  ExportOptions file = options_of_file(format, options, factor);
  const bool has_z_up = file.up == UpAxis::kZ;
  if (factor == 1 && !has_z_up) return placed_file(mesh, texturing, normals, format, library, file);
  const std::vector<CoarserLevel> coarser = placed_levels(options.coarser, factor);
  file.coarser = coarser;
  TriangleMesh placed = mesh;
  place(placed, normals, factor, has_z_up);
  return placed_file(placed, texturing, normals, format, library, file);
}

}  // namespace

std::optional<MeshFormat> format_of_extension(std::string_view extension) {
  if (extension.starts_with('.')) extension.remove_prefix(1);
  std::string lower(extension);
  for (char& c : lower)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  for (const ExportFormat& known : kExportFormats) {
    if (known.extension == lower) return known.format;
  }
  return std::nullopt;
}

Expected<std::vector<std::uint8_t>> write_mesh(const TriangleMesh& mesh, MeshFormat format,
                                               const ExportOptions& options) {
  if (auto ok = check(mesh); !ok) return tl::unexpected(ok.error());
  if (auto ok = check(format, options); !ok) return tl::unexpected(ok.error());
  if (auto ok = check(mesh, {}, format, options.coarser); !ok) return tl::unexpected(ok.error());
  return mesh_file(mesh, {}, format, {}, options);
}

std::string plain_name(std::string_view name) {
  const auto is_plain_byte = [](char c) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    return is_letter || (c >= '0' && c <= '9') || c == '.' || c == '-';
  };
  std::string out(name);
  std::ranges::replace_if(out, std::not_fn(is_plain_byte), '_');
  return out;
}

Expected<std::vector<MeshFile>> write_textured_mesh(const TriangleMesh& mesh, Texturing texturing,
                                                    MeshFormat format, std::string_view stem,
                                                    const ExportOptions& options) {
  if (roles_in(format).none()) texturing = {};
  if (auto ok = check(mesh); !ok) return tl::unexpected(ok.error());
  if (auto ok = check(mesh, texturing, format); !ok) return tl::unexpected(ok.error());
  if (options.compression != Compression::kNone && texturing.materials.size() > 1) {
    return fail(ErrorCode::kUnsupported,
                "a compressed GLB has one material; leave out the compression");
  }
  if (auto ok = check(format, options); !ok) return tl::unexpected(ok.error());
  if (auto ok = check(mesh, texturing, format, options.coarser); !ok)
    return tl::unexpected(ok.error());
  const std::string name = plain_name(stem), library = name + ".mtl";
  for (EncodedPicture& picture : texturing.pictures)
    picture.name = name + '_' + plain_name(picture.name);
  auto file = mesh_file(mesh, texturing, format, library, options);
  if (!file) return tl::unexpected(file.error());
  std::vector<MeshFile> files;
  files.push_back({name + '.' + std::string(row_of(format).extension), *std::move(file)});
  if (texturing.empty() || !has_companions(format)) return files;
  if (format == MeshFormat::kObj) files.push_back({library, write_obj_library(texturing)});
  for (EncodedPicture& picture : texturing.pictures)
    files.push_back({std::move(picture.name), std::move(picture.bytes)});
  return files;
}

std::string note_on_precision(const TriangleMesh& mesh, MeshFormat format) {
  if (format != MeshFormat::kStl && format != MeshFormat::kDrc) return {};
  const Bounds box = bounds_of(mesh.positions);
  if (!is_far_from_origin(box)) return {};
  char text[160];
  std::snprintf(
      text, sizeof text,
      "%s has single precision, which moves vertices so far from the origin by up to %.2g;"
      " write PLY, OBJ or GLB, which keep them",
      format == MeshFormat::kStl ? "STL" : "DRC", most_rounding(box));
  return text;
}

}  // namespace vitrine::inline codec
