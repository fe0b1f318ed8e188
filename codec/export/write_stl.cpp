// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "codec/export/file_writer.h"
#include "codec/export/writers.h"

namespace vitrine::inline codec {

FileBytes write_stl(const TriangleMesh& mesh, std::string_view unit) {
  FileWriter out(84 + mesh.faces.size() * 50);
  std::array<char, 80> title{};  // must not start with "solid", which marks the text format
  std::string text = "binary STL written by Vitrine";
  if (!unit.empty()) text.append(", unit ").append(unit);
  text.copy(title.data(), title.size());
  out.put(title);
  out.put(static_cast<std::uint32_t>(mesh.faces.size()));
  for (const auto& [a, b, c] : mesh.faces) {
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    const Vec3 normal = cross(q - p, r - p);
    const double size = length(normal);
    const bool flat = size > 0 && std::isfinite(size);
    out.put_reals(flat ? normal * (1 / size) : Vec3{});
    out.put_reals(p), out.put_reals(q), out.put_reals(r);
    out.put(std::uint16_t{0});
  }
  return out.take();
}

}  // namespace vitrine::inline codec
