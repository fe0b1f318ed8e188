// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "codec/export/file_writer.h"
#include "codec/export/statements.h"
#include "codec/export/writers.h"

namespace vitrine::inline codec {
namespace {

using Header = std::array<char, 80>;

// Returns the header: unit, axis, title and licence, as far as 80 bytes allow. The header must not
// start with "solid", which marks text STL. Replaces equals signs, because some programs read the
// bytes after "COLOR=" as a colour.
Header header_of(std::span<const Statement> statements) {
  std::string text = "Vitrine";
  for (const auto& [name, value] : statements) {
    if (name == "unit" || name == "up") text.append(", ").append(name).append(" ").append(value);
    if (name == "title" || name == "licence") text.append(", ").append(value);
  }
  std::ranges::replace(text, '=', ':');
  Header header{};
  std::size_t size = std::min(text.size(), header.size());
  while (size < text.size() && (static_cast<unsigned char>(text[size]) & 0xC0) == 0x80)
    --size;  // moves back to the start of a UTF-8 character
  text.copy(header.data(), size);
  return header;
}

}  // namespace

FileBytes write_stl(const TriangleMesh& mesh, std::span<const Statement> statements) {
  FileWriter out(84 + mesh.faces.size() * 50);
  out.put(header_of(statements));
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
