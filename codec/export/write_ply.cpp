// SPDX-License-Identifier: Apache-2.0
#include "codec/export/far_from_origin.h"
#include "codec/export/file_writer.h"
#include "codec/export/writers.h"

namespace vitrine::inline codec {

FileBytes write_ply(const TriangleMesh& mesh, std::string_view unit) {
  const bool coloured = !mesh.attributes.colours.empty();
  const bool far = is_far_from_origin(bounds_of(mesh.positions));
  FileWriter out(300 + mesh.positions.size() * ((far ? 24 : 12) + (coloured ? 3 : 0)) +
                 mesh.faces.size() * 13);
  out.text("ply\nformat binary_little_endian 1.0\ncomment written by Vitrine\n");
  if (!unit.empty()) out.text("comment unit "), out.text(unit), out.text("\n");
  out.text("element vertex ");
  out.number(mesh.positions.size());
  out.text(far ? "\nproperty double x\nproperty double y\nproperty double z\n"
               : "\nproperty float x\nproperty float y\nproperty float z\n");
  if (coloured) out.text("property uchar red\nproperty uchar green\nproperty uchar blue\n");
  out.text("element face ");
  out.number(mesh.faces.size());
  out.text("\nproperty list uchar int vertex_indices\nend_header\n");
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    far ? out.put_reals<double>(mesh.positions[v]) : out.put_reals(mesh.positions[v]);
    if (coloured) out.put(mesh.attributes.colours[v]);
  }
  for (const Triangle& face : mesh.faces) {
    out.put(std::uint8_t{3});
    out.put(face);
  }
  return out.take();
}

}  // namespace vitrine::inline codec
