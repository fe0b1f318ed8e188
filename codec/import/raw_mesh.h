// SPDX-License-Identifier: Apache-2.0
// What the readers fill in: vertices, and faces of any number of corners.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/vec.h"
#include "codec/import/read_mesh.h"

namespace vitrine {

class RawMesh {
 public:
  std::vector<Vec3> positions;
  std::vector<Colour> colours;  // empty, or as many as positions
  std::vector<std::string> repairs;
  // Vertices are repeated by design where an attribute jumps that is not carried, such as a normal,
  // or for each face: all of equal position and colour are welded. In other files those along
  // matching borders are (see seams.h).
  bool has_seams = false;
  // The colours were sampled from pictures or materials: vertices are welded whatever their
  // colours, which are averaged.
  bool is_baked = false;
  // For messages: the format's name, and the number that it gives to the first vertex.
  std::string_view format;
  std::uint32_t first_number = 0;

  // Faces are numbered from 0 in the order of these calls. Indices may refer to vertices to come.
  // `line` is where the face stands in a text, from 1.
  void add_triangle(const Triangle& face, std::uint64_t line = 0);
  void add_face(std::span<const std::uint32_t> corners, std::uint64_t line = 0);
  void reserve_faces(std::size_t count) { triangles_.reserve(count); }
  std::uint64_t face_count() const { return face_count_; }

  // Checks the indices and coordinates and cuts the polygons.
  Expected<ImportedMesh> finish(const Limits& limits) &&;

 private:
  void note_index(std::uint32_t index, std::uint64_t line);
  std::string numbered(std::uint32_t vertex) const;
  std::string face_of_max_index() const;
  Expected<void> check_counts(const Limits& limits) const;
  Expected<void> drop_stray_positions();
  void triangulate_polygons();
  void close_seams();

  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> polygon_corners_;  // of all faces with more than three corners
  std::vector<std::size_t> polygon_ends_;       // into polygon_corners_
  std::uint64_t face_count_ = 0;
  std::uint64_t small_faces_ = 0, first_small_face_ = 0;  // with fewer than three corners
  std::uint32_t max_index_ = 0;
  std::uint64_t max_index_face_ = 0, max_index_line_ = 0;
};

// "3 faces", "1 face": the number and the noun, plural by `s`.
std::string counted(std::uint64_t count, std::string_view noun);

// Text from a file made safe to print on one line: printable ASCII, at most 60 characters, quoted.
std::string in_quotes(std::string_view text);

// Whether a coordinate can be worked with: finite, and its square too.
bool is_usable(const Vec3& position);

// A colour component of 0..1 as 0..255, clamped; NaN becomes 0.
std::uint8_t to_byte(double unit);

Unexpected bad_input(std::string message);

// A file of points or lines, with the next step.
Unexpected no_faces(std::uint64_t points);

}  // namespace vitrine
