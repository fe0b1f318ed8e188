// SPDX-License-Identifier: Apache-2.0
// The mesh that readers fill in: vertices, and faces with any number of corners.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/limits.h"
#include "codec/core/vec.h"
#include "codec/mesh/texturing.h"
#include "codec/repair/face_list.h"
#include "codec/repair/grow_within.h"
#include "codec/repair/imported_mesh.h"

namespace vitrine::inline codec {

class RawMesh {
 public:
  std::vector<Vec3> positions;
  VertexAttributes attributes;
  std::vector<std::string> repairs;
  // Whether the file repeats vertices by design: either for each face, or where an attribute that
  // is not imported, such as normals, is discontinuous. If true, all vertices with equal positions
  // and colours are welded. If false, only vertices along matching borders are welded (see
  // seams.h).
  bool has_seams = false;
  // Whether the colours were sampled from pictures or materials. If true, vertices are welded even
  // if their colours differ, and these colours are averaged.
  bool is_baked = false;
  // The name of the format, and the number that it gives to the first vertex. Messages contain
  // them.
  std::string_view format;
  std::uint32_t first_number = 0;

  // The materials, and the pictures that their maps use. If there are no materials, the mesh has no
  // texturing.
  std::vector<Material> materials;
  std::vector<EncodedPicture> pictures;
  // Per set: the coordinates of each vertex, for files that do not have them per corner. Vertices
  // without an entry have (0, 0).
  std::array<std::vector<TextureCoordinates>, kCoordinateSets> vertex_coordinates;

  // Adds a face. Faces are numbered from 0 in the order of the calls. Indices may refer to vertices
  // that are added later. `line` is the number of the face's line in a text file, from 1, or 0 for
  // a binary file. `at_corners` is empty or has the texture coordinates of each corner, in set 0.
  void add_triangle(const Triangle& face, std::uint64_t line = 0);
  void add_face(std::span<const std::uint32_t> corners, std::uint64_t line = 0,
                std::span<const TextureCoordinates> at_corners = {});
  // Sets the material of the faces that are added from now on. Before the first call it is 0.
  void use_material(std::uint16_t material) { faces_.use_material(material); }
  void reserve_faces(std::size_t count) { faces_.triangles.reserve(count); }
  // Makes room for `count` triangles; see grow_within.h.
  void grow_faces(std::size_t count, std::size_t most) {
    grow_within(faces_.triangles, count, most);
  }
  std::uint64_t face_count() const { return face_count_; }

  // Checks the indices and positions, cuts the polygons into triangles and returns the mesh.
  Expected<ImportedMesh> finish(const Limits& limits) &&;

 private:
  void note_index(std::uint32_t index, std::uint64_t line);
  std::string numbered(std::uint32_t vertex) const;
  std::string face_of_max_index() const;
  Expected<void> check_counts(const Limits& limits) const;
  Expected<void> drop_stray_positions();
  void cut_polygons();
  Texturing take_texturing();
  void close_seams();

  FaceList faces_;
  std::uint64_t face_count_ = 0;
  std::uint64_t small_faces_ = 0, first_small_face_ = 0;  // faces with fewer than three corners
  std::uint32_t max_index_ = 0;
  std::uint64_t max_index_face_ = 0, max_index_line_ = 0;
};

// Returns the number and the noun, with "s" added for a plural: "3 faces", "1 face".
std::string counted(std::uint64_t count, std::string_view noun);

// Quotes text from a file and makes it safe to print on one line: at most 60 characters of
// printable ASCII.
std::string in_quotes(std::string_view text);

// Whether the coordinates are finite and small enough that their squares are finite, too.
bool is_usable(const Vec3& position);

Unexpected bad_input(std::string message);

// Returns the error for a file that has only points or lines, with advice for the user.
Unexpected no_faces(std::uint64_t points);

}  // namespace vitrine::inline codec
