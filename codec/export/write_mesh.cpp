// SPDX-License-Identifier: Apache-2.0
#include "codec/export/write_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "codec/export/far_from_origin.h"
#include "codec/export/write_drc.h"
#include "codec/export/writers.h"
#include "codec/mesh/unit.h"

namespace vitrine::inline codec {
namespace {

bool fits_float(const Vec3& p) {
  constexpr double kMost = std::numeric_limits<float>::max();
  return std::abs(p.x) <= kMost && std::abs(p.y) <= kMost && std::abs(p.z) <= kMost;
}

Expected<void> check(const TriangleMesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  if (mesh.faces.empty())
    return fail(ErrorCode::kBadInput, "there are no faces to write; ask for a finer level");
  // GLB and STL store sizes as 32-bit byte counts, and a face takes up to 50 bytes.
  if (mesh.faces.size() > 80'000'000 || vertices > 160'000'000) {
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

TriangleMesh in_metres(TriangleMesh mesh, std::string_view unit) {
  const double metres = metres_per(unit).value_or(1);
  for (Vec3& p : mesh.positions)
    p = p * metres;
  return mesh;
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
                                               std::string_view unit) {
  if (auto ok = check(mesh); !ok) return tl::unexpected(ok.error());
  switch (format) {
    case MeshFormat::kPly:
      return write_ply(mesh, unit);
    case MeshFormat::kGlb:
      return write_glb(in_metres(mesh, unit));
    case MeshFormat::kObj:
      return write_obj(mesh, unit);
    case MeshFormat::kStl:
      return write_stl(mesh, unit);
    case MeshFormat::kDrc:
      return write_drc(mesh);
    case MeshFormat::kVrml:
      return write_vrml(in_metres(mesh, unit));
  }
  return fail(ErrorCode::kUnsupported,
              "unknown mesh format; choose " + std::string(kExportExtensions));
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
