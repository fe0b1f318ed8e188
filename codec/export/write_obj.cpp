// SPDX-License-Identifier: Apache-2.0
// Writes OBJ [OBJ] and its material library, MTL. A textured mesh has texture coordinates instead
// of colours; their v axis points upwards.
#include "codec/export/far_from_origin.h"
#include "codec/export/file_writer.h"
#include "codec/export/seam_vertices.h"
#include "codec/export/statements.h"
#include "codec/export/writers.h"

namespace vitrine::inline codec {
namespace {

constexpr std::string_view kMaterial = "texture";

void put_positions(const TriangleMesh& mesh, bool is_coloured, FileWriter& out) {
  const bool far = is_far_from_origin(bounds_of(mesh.positions));
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    out.text("v ");
    far ? out.numbers<double>(mesh.positions[v]) : out.numbers(mesh.positions[v]);
    if (is_coloured) {
      const auto [r, g, b] = mesh.attributes.colours[v];
      out.text(" ");
      out.numbers(Vec3{r / 255.0, g / 255.0, b / 255.0});
    }
    out.text("\n");
  }
}

// Normal i belongs to vertex i, so a face corner refers to both by the same number.
void put_normals(std::span<const Vec3> normals, FileWriter& out) {
  for (const Vec3& normal : normals) {
    out.text("vn "), out.unit_vector(normal), out.text("\n");
  }
}

void put_faces(const TriangleMesh& mesh, bool has_normals, FileWriter& out) {
  for (const Triangle& face : mesh.faces) {
    out.text("f");
    for (const std::uint32_t v : face) {
      out.text(" "), out.number(v + 1);
      if (has_normals) out.text("//"), out.number(v + 1);
    }
    out.text("\n");
  }
}

void put_textured_faces(const TriangleMesh& mesh, const Texturing& texturing, bool has_normals,
                        FileWriter& out) {
  const SeamVertices split = split_at_seams(mesh, texturing);
  for (const auto& [u, v] : split.coordinates[0]) {
    out.text("vt "), out.number(u), out.text(" "), out.number(1 - v), out.text("\n");
  }
  out.text("usemtl "), out.text(kMaterial), out.text("\n");
  for (const Triangle& face : split.faces) {
    out.text("f");
    for (const std::uint32_t v : face) {
      const std::uint32_t number = split.original[v] + 1;
      out.text(" "), out.number(number), out.text("/"), out.number(v + 1);
      if (has_normals) out.text("/"), out.number(number);
    }
    out.text("\n");
  }
}

}  // namespace

FileBytes write_obj(const TriangleMesh& mesh, const Texturing& texturing,
                    std::span<const Vec3> normals, std::string_view library,
                    std::span<const Statement> statements) {
  const bool is_textured = !texturing.empty(), has_normals = !normals.empty();
  FileWriter out(4096 + mesh.positions.size() * 32 + normals.size() * 26 +
                 mesh.faces.size() * ((is_textured ? 64 : 24) + (has_normals ? 24 : 0)));
  out.text("# written by Vitrine\n");
  put_comments(out, "# ", statements);
  if (is_textured) out.text("mtllib "), out.text(library), out.text("\n");
  put_positions(mesh, !is_textured && !mesh.attributes.colours.empty(), out);
  put_normals(normals, out);
  is_textured ? put_textured_faces(mesh, texturing, has_normals, out)
              : put_faces(mesh, has_normals, out);
  return out.take();
}

FileBytes write_obj_library(const Texturing& texturing) {
  const Material& material = texturing.materials.front();
  FileWriter out(512);
  const auto put_map = [&](std::string_view keyword, const std::optional<TextureMap>& map) {
    if (!map) return;
    out.text(keyword), out.text(" "), out.text(texturing.pictures[map->picture].name);
    out.text("\n");
  };
  out.text("# written by Vitrine\nnewmtl "), out.text(kMaterial);
  out.text(material.is_unlit ? "\nillum 0\nKd 1 1 1\n" : "\nillum 1\nKd 1 1 1\n");
  out.text("Ke "), out.numbers(material.emission), out.text("\n");
  put_map("map_Kd", material.base_colour_map);
  if (material.alpha_mode != AlphaMode::kOpaque) put_map("map_d", material.base_colour_map);
  put_map("norm", material.normal_map);
  put_map("map_Ke", material.emission_map);
  return out.take();
}

}  // namespace vitrine::inline codec
