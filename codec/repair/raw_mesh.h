// SPDX-License-Identifier: Apache-2.0
// The mesh that readers build: vertices, and faces with any number of corners.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/limits.h"
#include "codec/core/printable.h"
#include "codec/core/vec.h"
#include "codec/mesh/texturing.h"
#include "codec/mesh/vertex_attributes.h"
#include "codec/repair/face_list.h"
#include "codec/repair/imported_mesh.h"

namespace vitrine::inline codec {

// Reserves room for `size` elements, which must not exceed `most`. The capacity doubles, as with
// push_back(), but never exceeds `most`. Many calls therefore take linear time, and the vector
// never gets larger than the file's data can require.
template <class T>
void grow_within(std::vector<T>& column, std::size_t size, std::size_t most) {
  if (size > column.capacity())
    column.reserve(std::max(size, std::min(2 * column.capacity(), most)));
}

class RawMesh {
 public:
  std::vector<Vec3> positions;
  VertexAttributes attributes;
  std::vector<std::string> repairs;
  // Whether the file repeats vertices by design. This is the case if each face has its own
  // vertices, or if vertices are repeated where an attribute such as normals is discontinuous. If
  // true, all vertices with equal positions and colours are merged. If false, only vertices along
  // matching borders are merged (weld_seams()).
  bool has_seams = false;
  // Whether the colours were sampled from pictures or materials. If true, vertices are merged even
  // if their colours differ, and their colours are averaged.
  bool is_baked = false;
  // Number of colours of vertices or faces that are not opaque. Their opacity is lost.
  std::uint64_t translucent_colours = 0;
  // The name of the format, and the number of the first vertex in that format. Both occur in
  // messages.
  std::string_view format;
  std::uint32_t first_number = 0;

  // The materials, and the pictures of their maps. If there are no materials, the mesh has no
  // texturing.
  std::vector<Material> materials;
  std::vector<EncodedPicture> pictures;
  // Per set: the texture coordinates of each vertex, if the file does not have them per corner.
  // Vertices without an entry have (0, 0).
  std::array<std::vector<TextureCoordinates>, kCoordinateSets> vertex_coordinates;

  // Adds a face. Faces are numbered from 0 in the order of these calls. Indices may refer to
  // vertices that are added later. `line` is the number of the face's line in a text file, from 1;
  // 0 if the file is binary. `at_corners` holds the texture coordinates (set 0) of the corners, or
  // is empty.
  void add_triangle(const Triangle& face, std::uint64_t line = 0);
  void add_face(std::span<const std::uint32_t> corners, std::uint64_t line = 0,
                std::span<const TextureCoordinates> at_corners = {});
  // Sets the material of all faces added after this call. The initial material is 0.
  void use_material(std::uint16_t material) { faces_.use_material(material); }
  void reserve_faces(std::size_t count) { faces_.triangles.reserve(count); }
  // Reserves room for `count` triangles; see grow_within().
  void grow_faces(std::size_t count, std::size_t most) {
    grow_within(faces_.triangles, count, most);
  }
  std::uint64_t face_count() const { return face_count_; }

  // Checks indices and positions, cuts polygons into triangles and returns the mesh.
  Expected<ImportedMesh> finish(const Limits& limits) &&;

 private:
  void note_index(std::uint32_t index, std::uint64_t line);
  std::string numbered(std::uint32_t vertex) const;
  std::string face_of_max_index() const;
  Expected<void> check_counts(const Limits& limits) const;
  Expected<void> drop_stray_positions();
  Texturing take_texturing();
  void close_seams();

  FaceList faces_;
  std::uint64_t face_count_ = 0;
  // Number of faces with fewer than three corners, and the index of the first such face.
  std::uint64_t small_faces_ = 0, first_small_face_ = 0;
  std::uint32_t max_index_ = 0;
  std::uint64_t max_index_face_ = 0, max_index_line_ = 0;
};

// Closes seams. A seam is a border along which a file repeats its vertices.
//
// Merges the vertices that are repeated along seams. Two border edges lie on a seam if they join
// the same two points with the same attributes. The ends of these two edges are then merged, unless
// one of the two faces is a copy or the reverse of the other. Coinciding vertices are not merged in
// three cases: their border edges do not coincide; they lie along an inner edge; or three or more
// border edges coincide.
//
// The remaining vertices keep their order. Returns the new index of each old vertex. Positions used
// by faces must be finite. Takes O(n log n) time.
std::vector<std::uint32_t> weld_seams(std::vector<Vec3>& positions, VertexAttributes& attributes,
                                      std::span<const Triangle> faces);

// Returns the number and the noun, in the plural if needed: "3 faces", "1 face".
std::string counted(std::uint64_t count, std::string_view noun);

// Whether the coordinates are finite and small enough that their squares are finite as well.
bool is_usable(const Vec3& position);

Unexpected bad_input(std::string message);

// Returns the error for a file that has only points or lines. The message advises the user.
Unexpected no_faces(std::uint64_t points);

}  // namespace vitrine::inline codec
