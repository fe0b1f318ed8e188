// SPDX-License-Identifier: Apache-2.0
// Writes binary PLY [PLY]. Stores a texture as MeshLab does. A comment TextureFile names the
// picture. Each face has a list `texcoord` of texture coordinates, whose v axis points upwards.
#include "codec/export/far_from_origin.h"
#include "codec/export/file_writer.h"
#include "codec/export/statements.h"
#include "codec/export/writers.h"

namespace vitrine::inline codec {
namespace {

class PlyFile {
 public:
  PlyFile(const TriangleMesh& mesh, const Texturing& texturing, std::span<const Vec3> normals)
      : mesh_(mesh),
        texturing_(texturing),
        normals_(normals),
        is_far_(is_far_from_origin(bounds_of(mesh.positions))),
        out_(4096 +
             mesh.positions.size() *
                 ((is_far_ ? 24 : 12) + (has_normals() ? 12 : 0) + (is_coloured() ? 3 : 0)) +
             mesh.faces.size() * (is_textured() ? 38 : 13)) {}

  FileBytes write(std::span<const Statement> statements) {
    put_header(statements);
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) {
      is_far_ ? out_.put_reals<double>(mesh_.positions[v]) : out_.put_reals(mesh_.positions[v]);
      if (has_normals()) out_.put_reals(normals_[v]);
      if (is_coloured()) out_.put(mesh_.attributes.colours[v]);
    }
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      out_.put(std::uint8_t{3});
      out_.put(mesh_.faces[f]);
      if (is_textured()) put_coordinates(f);
    }
    return out_.take();
  }

 private:
  bool has_normals() const { return !normals_.empty(); }
  bool is_textured() const { return !texturing_.empty(); }
  bool is_coloured() const { return !is_textured() && !mesh_.attributes.colours.empty(); }

  void put_header(std::span<const Statement> statements) {
    out_.text("ply\nformat binary_little_endian 1.0\ncomment written by Vitrine\n");
    put_comments(out_, "comment ", statements);
    if (is_textured()) {
      const std::uint32_t picture = texturing_.materials.front().base_colour_map->picture;
      out_.text("comment TextureFile "), out_.text(texturing_.pictures[picture].name);
      out_.text("\n");
    }
    out_.text("element vertex ");
    out_.number(mesh_.positions.size());
    out_.text(is_far_ ? "\nproperty double x\nproperty double y\nproperty double z\n"
                      : "\nproperty float x\nproperty float y\nproperty float z\n");
    if (has_normals()) out_.text("property float nx\nproperty float ny\nproperty float nz\n");
    if (is_coloured()) out_.text("property uchar red\nproperty uchar green\nproperty uchar blue\n");
    out_.text("element face ");
    out_.number(mesh_.faces.size());
    out_.text("\nproperty list uchar int vertex_indices\n");
    if (is_textured()) out_.text("property list uchar float texcoord\n");
    out_.text("end_header\n");
  }

  void put_coordinates(std::size_t face) {
    out_.put(std::uint8_t{6});
    for (const auto& [u, v] : texturing_.coordinates[0][face])
      out_.put(u), out_.put(1 - v);
  }

  const TriangleMesh& mesh_;
  const Texturing& texturing_;
  std::span<const Vec3> normals_;
  bool is_far_;
  FileWriter out_;
};

}  // namespace

FileBytes write_ply(const TriangleMesh& mesh, const Texturing& texturing,
                    std::span<const Vec3> normals, std::span<const Statement> statements) {
  return PlyFile(mesh, texturing, normals).write(statements);
}

}  // namespace vitrine::inline codec
