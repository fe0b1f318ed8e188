// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/raw_mesh.h"

#include <algorithm>
#include <cmath>

#include "codec/repair/face_texturing.h"
#include "codec/repair/keep_vertices.h"
#include "codec/repair/raw_mesh.h"
#include "codec/repair/weld.h"

namespace vitrine::inline codec {
namespace {

// Larger coordinates could make squares or cross products infinite. The limit is slightly above
// 1e30, because 1e30 rounds up in single precision.
constexpr double kLargestCoordinate = 1.0000001e30;

}  // namespace

std::string counted(std::uint64_t count, std::string_view noun) {
  return std::to_string(count) + ' ' + std::string(noun) + (count == 1 ? "" : "s");
}

bool is_usable(const Vec3& p) {
  return std::abs(p.x) <= kLargestCoordinate && std::abs(p.y) <= kLargestCoordinate &&
         std::abs(p.z) <= kLargestCoordinate;
}

Unexpected bad_input(std::string message) {
  return fail(ErrorCode::kBadInput, std::move(message));
}

Unexpected no_faces(std::uint64_t points) {
  return bad_input("the file has " + counted(points, "point") +
                   " but no faces; Vitrine needs a surface, so mesh the points first");
}

void RawMesh::note_index(std::uint32_t index, std::uint64_t line) {
  if (index <= max_index_) return;
  max_index_ = index;
  max_index_face_ = face_count_;
  max_index_line_ = line;
}

// Returns a description such as "vertex 7 (counted from 1)".
std::string RawMesh::numbered(std::uint32_t vertex) const {
  return "vertex " + std::to_string(std::uint64_t{vertex} + first_number) + " (counted from " +
         std::to_string(first_number) + ')';
}

std::string RawMesh::face_of_max_index() const {
  if (max_index_line_ == 0) return "face " + std::to_string(max_index_face_);
  return std::string(format) + " line " + std::to_string(max_index_line_) + ": this face";
}

void RawMesh::add_triangle(const Triangle& face, std::uint64_t line) {
  for (const std::uint32_t v : face)
    note_index(v, line);
  faces_.add(face);
  ++face_count_;
}

void RawMesh::add_face(std::span<const std::uint32_t> corners, std::uint64_t line,
                       std::span<const TextureCoordinates> at_corners) {
  if (corners.size() < 3) {
    if (small_faces_++ == 0) first_small_face_ = face_count_;
  } else {
    for (const std::uint32_t v : corners)
      note_index(v, line);
    faces_.add(corners, at_corners);
  }
  ++face_count_;
}

Expected<void> RawMesh::check_counts(const Limits& limits) const {
  if (positions.empty()) return bad_input("the file has no vertices; export the surface again");
  if (faces_.empty()) return no_faces(positions.size());
  if (max_index_ >= positions.size()) {
    const std::string vertex =
        max_index_ == 0xFFFF'FFFFu
            ? "a vertex below 0 or beyond 32 bits"
            : numbered(max_index_) + ", but the file has only " + std::to_string(positions.size());
    return bad_input(face_of_max_index() + " refers to " + vertex +
                     "; the file is damaged, export it again");
  }
  if (positions.size() > limits.vertices || faces_.triangles.size() > limits.faces) {
    return fail(ErrorCode::kLimit, "the mesh has " + std::to_string(positions.size()) +
                                       " vertices and " + counted(face_count_, "face") +
                                       ", more than this installation accepts; simplify it first");
  }
  return {};
}

// Returns the texturing of the triangles. Call this while the vertices are still as the reader
// added them.
Texturing RawMesh::take_texturing() {
  Texturing out;
  if (materials.empty()) return out;
  out.materials = std::move(materials);
  out.pictures = std::move(pictures);
  out.face_materials = faces_.take_materials();
  out.coordinates[0] = std::move(faces_.coordinates);
  for (std::size_t s = 0; s < kCoordinateSets; ++s) {
    const auto of_vertices = std::move(vertex_coordinates[s]);
    if (out.coordinates[s].empty() && !of_vertices.empty())
      out.coordinates[s] = coordinates_of_corners(faces_.triangles, of_vertices);
  }
  fit_coordinate_sets(out);
  if (const std::uint64_t count = make_finite(out); count > 0) {
    repairs.push_back(counted(count, "texture coordinate") +
                      " without finite values set to 0; check the texture there");
  }
  return out;
}

// Removes unusable positions that no face uses. Range scanners mark missing samples by NaN. Fails
// if a face uses an unusable position.
Expected<void> RawMesh::drop_stray_positions() {
  if (std::all_of(positions.begin(), positions.end(), is_usable)) return {};
  const std::vector<bool> used = used_vertices(positions.size(), faces_.triangles);
  std::vector<bool> usable(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    usable[v] = is_usable(positions[v]);
    if (usable[v] || !used[v]) continue;
    return bad_input(numbered(static_cast<std::uint32_t>(v)) +
                     " has a coordinate that is not a finite number (or beyond 1e30) and faces "
                     "use it; remove it and export again");
  }
  const std::size_t dropped = keep_vertices(usable, positions, attributes, faces_.triangles);
  repairs.push_back(counted(dropped, "point") +
                    " without finite coordinates dropped; no face uses them");
  return {};
}

void RawMesh::close_seams() {
  const std::size_t before = positions.size();
  std::vector<Colour> baked;
  if (is_baked) baked.swap(attributes.colours);
  const std::vector<std::uint32_t> renamed =
      has_seams ? weld(positions, attributes) : weld_seams(positions, attributes, faces_.triangles);
  const std::size_t welded = before - positions.size();
  if (is_baked) {
    attributes.colours = welded > 0 ? blended(renamed, positions.size(), baked) : std::move(baked);
  }
  if (welded == 0) return;
  for (Triangle& face : faces_.triangles) {
    for (std::uint32_t& v : face)
      v = renamed[v];
  }
  repairs.push_back(
      std::to_string(welded) +
      (welded == 1 ? " repeated vertex welded" : " repeated vertices welded") +
      (has_seams ? ", parted by normals, textures or missing indices" : " along matching borders") +
      "; no step is needed");
}

Expected<ImportedMesh> RawMesh::finish(const Limits& limits) && {
  if (auto ok = check_counts(limits); !ok) return tl::unexpected(ok.error());
  if (materials.empty()) faces_.drop_texturing();
  faces_.cut_polygons(positions);
  if (faces_.triangles.size() > limits.faces) {
    return fail(ErrorCode::kLimit, "the mesh has " + counted(faces_.triangles.size(), "triangle") +
                                       ", more than this installation accepts; simplify it first");
  }
  Texturing texturing = take_texturing();
  if (auto ok = drop_stray_positions(); !ok) return tl::unexpected(ok.error());
  close_seams();
  if (small_faces_ > 0) {
    repairs.push_back(counted(small_faces_, "face") +
                      " with fewer than three corners dropped, first at face " +
                      std::to_string(first_small_face_) + "; convert what you need to polygons");
  }
  if (translucent_colours > 0) {
    repairs.push_back("opacity of " + counted(translucent_colours, "colour") +
                      " not carried: vertex colours are opaque; use a material with a texture map");
  }
  return ImportedMesh{.mesh = {.positions = std::move(positions),
                               .faces = std::move(faces_.triangles),
                               .attributes = std::move(attributes)},
                      .unit = {},
                      .repairs = std::move(repairs),
                      .texturing = std::move(texturing)};
}

}  // namespace vitrine::inline codec
