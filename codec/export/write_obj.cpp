// SPDX-License-Identifier: Apache-2.0
#include "codec/export/far_from_origin.h"
#include "codec/export/file_writer.h"
#include "codec/export/writers.h"

namespace vitrine::inline codec {

FileBytes write_obj(const TriangleMesh& mesh, std::string_view unit) {
  const bool far = is_far_from_origin(bounds_of(mesh.positions));
  FileWriter out(64 + mesh.positions.size() * 32 + mesh.faces.size() * 24);
  out.text("# written by Vitrine\n");
  if (!unit.empty()) out.text("# unit "), out.text(unit), out.text("\n");
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    out.text("v ");
    far ? out.numbers<double>(mesh.positions[v]) : out.numbers(mesh.positions[v]);
    if (!mesh.attributes.colours.empty()) {
      const auto [r, g, b] = mesh.attributes.colours[v];
      out.text(" ");
      out.numbers(Vec3{r / 255.0, g / 255.0, b / 255.0});
    }
    out.text("\n");
  }
  for (const Triangle& face : mesh.faces) {
    out.text("f");
    for (const std::uint32_t v : face)
      out.text(" "), out.number(v + 1);
    out.text("\n");
  }
  return out.take();
}

}  // namespace vitrine::inline codec
