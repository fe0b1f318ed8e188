// SPDX-License-Identifier: Apache-2.0
// Writes VRML 97 [VRML97] with one shape, an IndexedFaceSet.
#include "codec/export/far_from_origin.h"
#include "codec/export/file_writer.h"
#include "codec/export/writers.h"

namespace vitrine::inline codec {
namespace {

constexpr std::string_view kOpening =
    "#VRML V2.0 utf8\n"
    "# written by Vitrine\n"
    "Shape {\n"
    "  appearance Appearance { material Material { } }\n"
    "  geometry IndexedFaceSet {\n"
    "    solid FALSE\n"        // makes faces visible from both sides, for open surfaces
    "    creaseAngle 0.785\n"  // 45 degrees: shading is smooth across edges with smaller angles
    "    coord Coordinate {\n"
    "      point [\n";

}  // namespace

FileBytes write_vrml(const TriangleMesh& mesh) {
  const bool far = is_far_from_origin(bounds_of(mesh.positions));
  FileWriter out(512 + mesh.positions.size() * 44 + mesh.faces.size() * 28);
  out.text(kOpening);
  for (const Vec3& p : mesh.positions)
    (far ? out.numbers<double>(p) : out.numbers(p)), out.text(",\n");
  out.text("      ]\n    }\n    coordIndex [\n");
  for (const Triangle& face : mesh.faces) {
    for (const std::uint32_t v : face)
      out.number(v), out.text(" ");
    out.text("-1\n");
  }
  out.text("    ]\n");
  if (!mesh.attributes.colours.empty()) {
    out.text("    colorPerVertex TRUE\n    color Color {\n      color [\n");
    for (const auto& [r, g, b] : mesh.attributes.colours) {
      out.numbers(Vec3{r / 255.0, g / 255.0, b / 255.0}), out.text(",\n");
    }
    out.text("      ]\n    }\n");
  }
  out.text("  }\n}\n");
  return out.take();
}

}  // namespace vitrine::inline codec
