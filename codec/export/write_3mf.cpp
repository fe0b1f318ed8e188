// SPDX-License-Identifier: Apache-2.0
// Writes 3MF [3MF]: a package with one object. Vertex colours are a colour group of the materials
// extension, whose colour i belongs to vertex i. 3MF has no normals.
#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "codec/core/html.h"
#include "codec/export/far_from_origin.h"
#include "codec/export/file_writer.h"
#include "codec/export/statements.h"
#include "codec/export/writers.h"
#include "codec/export/zip.h"

namespace vitrine::inline codec {
namespace {

constexpr std::string_view kContentTypes =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
)";
constexpr std::string_view kRelationships =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
)";
constexpr std::string_view kNamespaces =
    R"( xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02")"
    R"( xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02")";

using NamePair = std::pair<std::string_view, std::string_view>;
constexpr NamePair kUnitNames[] = {
    {"mm", "millimeter"}, {"cm", "centimeter"}, {"m", "meter"}, {"in", "inch"}};
// Names of statements, each with its metadata name in 3MF.
constexpr NamePair kMetadataNames[] = {{"title", "Title"},
                                       {"creator", "Designer"},
                                       {"rights", "Copyright"},
                                       {"licence", "LicenseTerms"}};

// Returns the name that 3MF has for `own`, or an empty string if there is none.
std::string_view name_in_3mf(std::span<const NamePair> names, std::string_view own) {
  const auto found = std::ranges::find(names, own, &NamePair::first);
  return found == names.end() ? std::string_view() : found->second;
}

template <class Number>
void put_number(FileWriter& out, std::string_view name, Number value) {
  out.text(" "), out.text(name), out.text("=\""), out.number(value), out.text("\"");
}

void put_text(FileWriter& out, std::string_view name, std::string_view value) {
  out.text(" "), out.text(name), out.text("=\""), out.text(escape_html(value)), out.text("\"");
}

void put_metadatum(FileWriter& out, std::string_view name, std::string_view text) {
  out.text("<metadata"), put_text(out, "name", name), out.text(">");
  out.text(escape_html(text)), out.text("</metadata>\n");
}

// Writes the statements as metadata. Statements for which 3MF has no name go into the description.
void put_metadata(std::span<const Statement> statements, FileWriter& out) {
  std::string description;
  for (const auto& [name, text] : statements) {
    const std::string_view known = name_in_3mf(kMetadataNames, name);
    if (known.empty()) {
      description += (description.empty() ? "" : ", ") + std::string(name) + ' ' + text;
    } else {
      put_metadatum(out, known, text);
    }
  }
  put_metadatum(out, "Description", description);
  put_metadatum(out, "Application", "Vitrine");
}

void put_colour_group(std::span<const Colour> colours, FileWriter& out) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  out.text("<m:colorgroup id=\"1\">\n");
  for (const Colour& colour : colours) {
    out.text("<m:color color=\"#");
    for (const std::uint8_t part : colour)
      out.put(kDigits[part >> 4]), out.put(kDigits[part & 15]);
    out.text("\"/>\n");
  }
  out.text("</m:colorgroup>\n");
}

void put_vertices(const TriangleMesh& mesh, FileWriter& out) {
  const bool far = is_far_from_origin(bounds_of(mesh.positions));
  const auto put = [&](std::string_view axis, double value) {
    far ? put_number(out, axis, value) : put_number(out, axis, static_cast<float>(value));
  };
  out.text("<vertices>\n");
  for (const Vec3& p : mesh.positions) {
    out.text("<vertex"), put("x", p.x), put("y", p.y), put("z", p.z), out.text("/>\n");
  }
  out.text("</vertices>\n");
}

void put_triangles(const TriangleMesh& mesh, bool is_coloured, FileWriter& out) {
  out.text("<triangles>\n");
  for (const auto& [a, b, c] : mesh.faces) {
    if (a == b || b == c || c == a) continue;  // 3MF forbids triangles with equal corners
    out.text("<triangle"), put_number(out, "v1", a), put_number(out, "v2", b);
    put_number(out, "v3", c);
    if (is_coloured) {
      out.text(" pid=\"1\""), put_number(out, "p1", a), put_number(out, "p2", b);
      put_number(out, "p3", c);
    }
    out.text("/>\n");
  }
  out.text("</triangles>\n");
}

// The object has the type "model", although its surface may be open. Slicers repair open surfaces
// of this type, and do not load other types.
void put_object(const TriangleMesh& mesh, std::string_view title, FileWriter& out) {
  const bool is_coloured = !mesh.attributes.colours.empty();
  if (is_coloured) put_colour_group(mesh.attributes.colours, out);
  out.text("<object id=\"2\" type=\"model\"");
  if (!title.empty()) put_text(out, "name", title);
  if (is_coloured) out.text(" pid=\"1\" pindex=\"0\"");
  out.text(">\n<mesh>\n");
  put_vertices(mesh, out);
  put_triangles(mesh, is_coloured, out);
  out.text("</mesh>\n</object>\n");
}

std::size_t expected_size(const TriangleMesh& mesh) {
  const bool is_coloured = !mesh.attributes.colours.empty();
  return 4096 + mesh.positions.size() * (is_coloured ? 88 : 60) +
         mesh.faces.size() * (is_coloured ? 100 : 56);
}

FileBytes model_part(const TriangleMesh& mesh, const ExportOptions& options) {
  FileWriter out(expected_size(mesh));
  out.text("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model");
  const std::string_view unit = name_in_3mf(kUnitNames, options.unit);
  if (!unit.empty()) put_text(out, "unit", unit);
  out.text(kNamespaces), out.text(">\n");
  put_metadata(statements_of(options), out);
  out.text("<resources>\n");
  put_object(mesh, one_line(options.about.title), out);
  out.text("</resources>\n<build>\n<item objectid=\"2\"/>\n</build>\n</model>\n");
  return out.take();
}

FileBytes bytes_of_text(std::string_view text) {
  return {text.begin(), text.end()};
}

}  // namespace

Expected<FileBytes> write_3mf(const TriangleMesh& mesh, const ExportOptions& options) {
  // zip() has the same limit, but would check it only after the whole text is in memory.
  if (expected_size(mesh) > std::numeric_limits<std::uint32_t>::max())
    return fail(ErrorCode::kLimit, "the mesh is too large for 3MF; ask for fewer triangles");
  const MeshFile parts[] = {{"[Content_Types].xml", bytes_of_text(kContentTypes)},
                            {"_rels/.rels", bytes_of_text(kRelationships)},
                            {"3D/3dmodel.model", model_part(mesh, options)}};
  return zip(parts);
}

}  // namespace vitrine::inline codec
