// SPDX-License-Identifier: Apache-2.0
// Writes USDZ [USDZ]: a package that contains a USD layer as text [USDA] and the pictures of its
// texture. The layer has one mesh. Colours are in linear light. If the mesh is far from the origin,
// its points are relative to a transform, which has double precision.
#include <string>

#include "codec/core/srgb.h"
#include "codec/export/far_from_origin.h"
#include "codec/export/file_writer.h"
#include "codec/export/seam_vertices.h"
#include "codec/export/statements.h"
#include "codec/export/usd_material.h"
#include "codec/export/writers.h"
#include "codec/export/zip.h"
#include "codec/mesh/unit.h"

namespace vitrine::inline codec {
namespace {

constexpr std::string_view kMeshStart = R"(
    def Mesh "mesh" (
        prepend apiSchemas = ["MaterialBindingAPI"]
    )
    {
        rel material:binding = </model/material>
        uniform token subdivisionScheme = "none"
)";

// Writes the metadata of the layer. If a file states no unit, readers assume centimetres. If the
// unit is unknown, the layer therefore states metres, as GLB files do, and its statements say that
// the unit is unknown.
void put_layer_metadata(const ExportOptions& options, FileWriter& out) {
  out.text("#usda 1.0\n(\n    defaultPrim = \"model\"\n");
  if (const std::string title = one_line(options.about.title); !title.empty())
    out.text("    doc = "), out.quoted(title), out.text("\n");
  out.text("    metersPerUnit = "), out.number(metres_per(options.unit).value_or(1));
  const bool has_z_up = options.up == UpAxis::kZ;
  out.text(has_z_up ? "\n    upAxis = \"Z\"\n" : "\n    upAxis = \"Y\"\n");
  out.text("    customLayerData = {\n");
  for (const auto& [name, text] : statements_of(options)) {
    out.text("        string "), out.text(name), out.text(" = "), out.quoted(text);
    out.text("\n");
  }
  out.text("    }\n)\n");
}

// Writes an attribute of the mesh as an array of `count` values, each written by put(i).
// `interpolation` states how USD assigns the values to the surface.
template <class Put>
void put_array(FileWriter& out, std::string_view declaration, std::size_t count, const Put& put,
               std::string_view interpolation = {}) {
  out.text("        "), out.text(declaration), out.text(" = [");
  for (std::size_t i = 0; i < count; ++i)
    out.text(i == 0 ? "" : ","), put(i);
  out.text("]");
  if (!interpolation.empty())
    out.text(" (\n            interpolation = "), out.quoted(interpolation),
        out.text("\n        )");
  out.text("\n");
}

void put_index_array(FileWriter& out, std::string_view declaration,
                     std::span<const Triangle> faces) {
  put_array(out, declaration, faces.size(), [&](std::size_t f) {
    const auto [a, b, c] = faces[f];
    out.number(a), out.text(","), out.number(b), out.text(","), out.number(c);
  });
}

void put_tuple(FileWriter& out, const Vec3& v) {
  out.text("("), out.numbers(v, ","), out.text(")");
}

void put_shape(const TriangleMesh& mesh, std::span<const Vec3> normals, const Vec3& place,
               FileWriter& out) {
  const Bounds box = bounds_of(mesh.positions);
  out.text("        float3[] extent = [");
  put_tuple(out, box.low - place), out.text(","), put_tuple(out, box.high - place);
  out.text("]\n");
  put_array(out, "int[] faceVertexCounts", mesh.faces.size(), [&](std::size_t) { out.text("3"); });
  put_index_array(out, "int[] faceVertexIndices", mesh.faces);
  put_array(out, "point3f[] points", mesh.positions.size(),
            [&](std::size_t v) { put_tuple(out, mesh.positions[v] - place); });
  if (normals.empty()) return;
  put_array(
      out, "normal3f[] normals", normals.size(),
      [&](std::size_t v) { out.text("("), out.unit_vector(normals[v], ","), out.text(")"); },
      "vertex");
}

// Writes the texture coordinates. In USD, (0, 0) is the lower left corner of the picture, so the
// second coordinate is flipped.
void put_st(const SeamVertices& split, FileWriter& out) {
  const auto& coordinates = split.coordinates[0];
  put_array(
      out, "texCoord2f[] primvars:st", coordinates.size(),
      [&](std::size_t v) {
        const auto [s, t] = coordinates[v];
        out.text("("), out.number(s), out.text(","), out.number(1 - t), out.text(")");
      },
      "faceVarying");
  put_index_array(out, "int[] primvars:st:indices", split.faces);
}

void put_display_colours(std::span<const Colour> colours, FileWriter& out) {
  const auto linear = [](std::uint8_t part) { return srgb_to_linear(part / 255.0); };
  put_array(
      out, "color3f[] primvars:displayColor", colours.size(),
      [&](std::size_t v) {
        const auto [r, g, b] = colours[v];
        put_tuple(out, {linear(r), linear(g), linear(b)});
      },
      "vertex");
}

void put_place(const Vec3& place, FileWriter& out) {
  if (place == Vec3{}) return;
  out.text("    matrix4d xformOp:transform = ((1,0,0,0),(0,1,0,0),(0,0,1,0),(");
  out.numbers<double>(place, ",");
  out.text(",1))\n    uniform token[] xformOpOrder = [\"xformOp:transform\"]\n");
}

FileBytes usd_layer(const TriangleMesh& mesh, const Texturing& texturing,
                    std::span<const Vec3> normals, const ExportOptions& options) {
  const Bounds box = bounds_of(mesh.positions);
  const Vec3 place = is_far_from_origin(box) ? box.centre() : Vec3{};
  const bool is_textured = !texturing.empty();
  const bool is_coloured = !is_textured && !mesh.attributes.colours.empty();
  const bool is_double_sided = !is_textured || texturing.materials.front().is_double_sided;
  FileWriter out(8192 + mesh.positions.size() * (is_coloured ? 68 : 34) + normals.size() * 26 +
                 mesh.faces.size() * (is_textured ? 60 : 24));
  put_layer_metadata(options, out);
  out.text("\ndef Xform \"model\"\n{\n"), put_place(place, out);
  out.text(kMeshStart);
  if (is_double_sided) out.text("        uniform bool doubleSided = 1\n");
  put_shape(mesh, normals, place, out);
  if (is_textured) put_st(split_at_seams(mesh, texturing), out);
  if (is_coloured) put_display_colours(mesh.attributes.colours, out);
  out.text("    }\n");
  is_textured ? put_usd_material(out, texturing) : put_plain_usd_material(out, is_coloured);
  out.text("}\n");
  return out.take();
}

}  // namespace

Expected<FileBytes> write_usdz(const TriangleMesh& mesh, const Texturing& texturing,
                               std::span<const Vec3> normals, const ExportOptions& options) {
  std::vector<MeshFile> files;
  files.push_back({"model.usda", usd_layer(mesh, texturing, normals, options)});
  for (const EncodedPicture& picture : texturing.pictures)
    files.push_back({picture.name, picture.bytes});
  return stored_zip(files);
}

}  // namespace vitrine::inline codec
