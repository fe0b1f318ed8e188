// SPDX-License-Identifier: Apache-2.0
// Writes VRML 97 [VRML97]: one shape with an IndexedFaceSet. The shape has vertex colours, or
// texture coordinates and an ImageTexture.
#include "codec/export/far_from_origin.h"
#include "codec/export/file_writer.h"
#include "codec/export/seam_vertices.h"
#include "codec/export/statements.h"
#include "codec/export/writers.h"

namespace vitrine::inline codec {
namespace {

constexpr std::string_view kOpening =
    "#VRML V2.0 utf8\n"
    "# written by Vitrine\n";
constexpr std::string_view kShape =
    "Shape {\n"
    "  appearance Appearance {\n"
    "    material Material { }\n";
constexpr std::string_view kGeometry =
    "  }\n"
    "  geometry IndexedFaceSet {\n"
    "    solid FALSE\n"  // draws both sides of faces, because surfaces may be open
    "    coord Coordinate {\n"
    "      point [\n";

void put_world_info(std::span<const Statement> statements, FileWriter& out) {
  out.text("WorldInfo {\n");
  for (const auto& [name, text] : statements) {
    if (name != "title") continue;
    out.text("  title "), out.quoted(text), out.text("\n");
  }
  out.text("  info [\n");
  for (const auto& [name, text] : statements) {
    if (name == "title") continue;
    out.text("    "), out.quoted(std::string(name) + ' ' + text), out.text(",\n");
  }
  out.text("  ]\n}\n");
}

void put_texture(const Texturing& texturing, FileWriter& out) {
  const std::uint32_t picture = texturing.materials.front().base_colour_map->picture;
  out.text("    texture ImageTexture {\n      url \""), out.text(texturing.pictures[picture].name);
  out.text("\"\n      repeatS FALSE\n      repeatT FALSE\n    }\n");
}

void put_indices(std::string_view field, const std::vector<Triangle>& faces, FileWriter& out) {
  out.text("    "), out.text(field), out.text(" [\n");
  for (const Triangle& face : faces) {
    for (const std::uint32_t v : face)
      out.number(v), out.text(" ");
    out.text("-1\n");
  }
  out.text("    ]\n");
}

void put_colours(const std::vector<Colour>& colours, FileWriter& out) {
  out.text("    colorPerVertex TRUE\n    color Color {\n      color [\n");
  for (const auto& [r, g, b] : colours) {
    out.numbers(Vec3{r / 255.0, g / 255.0, b / 255.0}), out.text(",\n");
  }
  out.text("      ]\n    }\n");
}

// The file has no list of normal indices, so VRML assigns normal i to point i.
void put_vectors(std::span<const Vec3> normals, FileWriter& out) {
  if (normals.empty()) return;
  out.text("    normal Normal {\n      vector [\n");
  for (const Vec3& normal : normals)
    out.unit_vector(normal), out.text(",\n");
  out.text("      ]\n    }\n");
}

// Writes texture coordinates with v counted upwards: in VRML, (0, 0) is the lower left corner of
// the picture.
void put_coordinates(const SeamVertices& split, FileWriter& out) {
  out.text("    texCoord TextureCoordinate {\n      point [\n");
  for (const auto& [u, v] : split.coordinates[0]) {
    out.number(u), out.text(" "), out.number(1 - v), out.text(",\n");
  }
  out.text("      ]\n    }\n");
  put_indices("texCoordIndex", split.faces, out);
}

}  // namespace

FileBytes write_vrml(const TriangleMesh& mesh, const Texturing& texturing,
                     std::span<const Vec3> normals, std::span<const Statement> statements) {
  const bool far = is_far_from_origin(bounds_of(mesh.positions));
  const bool is_textured = !texturing.empty();
  FileWriter out(4096 + mesh.positions.size() * 44 + normals.size() * 25 +
                 mesh.faces.size() * (is_textured ? 72 : 28));
  out.text(kOpening);
  put_world_info(statements, out);
  out.text(kShape);
  if (is_textured) put_texture(texturing, out);
  out.text(kGeometry);
  for (const Vec3& p : mesh.positions)
    (far ? out.numbers<double>(p) : out.numbers(p)), out.text(",\n");
  out.text("      ]\n    }\n");
  put_indices("coordIndex", mesh.faces, out);
  put_vectors(normals, out);
  if (is_textured) {
    put_coordinates(split_at_seams(mesh, texturing), out);
  } else if (!mesh.attributes.colours.empty()) {
    put_colours(mesh.attributes.colours, out);
  }
  out.text("  }\n}\n");
  return out.take();
}

}  // namespace vitrine::inline codec
