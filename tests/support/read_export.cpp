// SPDX-License-Identifier: Apache-2.0
#include "support/read_export.h"

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "codec/import/read_mesh.h"
#include "support/packages/read_zip.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

// Returns the numbers before `end`. Spaces, commas and parentheses may separate them.
std::vector<double> numbers_in(std::string text, char end) {
  text.resize(std::min(text.find(end), text.size()));
  std::ranges::replace_if(
      text, [](char c) { return c == ',' || c == '(' || c == ')'; }, ' ');
  std::istringstream words(text);
  return {std::istream_iterator<double>(words), {}};
}

TriangleMesh read_drc(std::span<const std::uint8_t> file) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(file.data()), file.size());
  const auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) throw std::runtime_error(decoded.status().error_msg_string());
  const draco::Mesh& mesh = *decoded.value();
  const auto* positions = mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  TriangleMesh out;
  for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
    std::array<float, 3> p{};
    positions->GetMappedValue(point, p.data());
    out.positions.push_back({p[0], p[1], p[2]});
  }
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
    const auto& face = mesh.face(f);
    out.faces.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return out;
}

TriangleMesh read_vrml(std::span<const std::uint8_t> file) {
  const std::string text(file.begin(), file.end());
  const auto points = vrml_list(text, "point"), indices = vrml_list(text, "coordIndex");
  TriangleMesh out;
  for (std::size_t i = 0; i + 3 <= points.size(); i += 3)
    out.positions.push_back({points[i], points[i + 1], points[i + 2]});
  for (std::size_t i = 0; i + 4 <= indices.size(); i += 4) {
    out.faces.push_back({static_cast<std::uint32_t>(indices[i]),
                         static_cast<std::uint32_t>(indices[i + 1]),
                         static_cast<std::uint32_t>(indices[i + 2])});
  }
  return out;
}

TriangleMesh read_usdz(std::span<const std::uint8_t> file) {
  const std::string layer =
      read_zip({reinterpret_cast<const char*>(file.data()), file.size()}).at("model.usda");
  const auto points = usd_list(layer, "point3f[] points"),
             indices = usd_list(layer, "int[] faceVertexIndices");
  Vec3 place;
  const std::string transform = "matrix4d xformOp:transform = ((1,0,0,0),(0,1,0,0),(0,0,1,0),(";
  if (const std::size_t at = layer.find(transform); at != layer.npos) {
    const std::vector<double> row = numbers_in(layer.substr(at + transform.size(), 100), ')');
    place = {row.at(0), row.at(1), row.at(2)};
  }
  TriangleMesh out;
  for (std::size_t i = 0; i + 3 <= points.size(); i += 3)
    out.positions.push_back(Vec3{points[i], points[i + 1], points[i + 2]} + place);
  for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
    out.faces.push_back({static_cast<std::uint32_t>(indices[i]),
                         static_cast<std::uint32_t>(indices[i + 1]),
                         static_cast<std::uint32_t>(indices[i + 2])});
  }
  return out;
}

}  // namespace

TriangleMesh read_export(std::span<const std::uint8_t> file, MeshFormat format) {
  if (format == MeshFormat::kDrc) return read_drc(file);
  if (format == MeshFormat::kVrml) return read_vrml(file);
  if (format == MeshFormat::kUsdz) return read_usdz(file);
  auto imported = read_mesh(file);
  if (!imported) throw std::runtime_error(imported.error().message);
  return std::move(imported->mesh);
}

std::vector<double> vrml_list(const std::string& text, const std::string& keyword) {
  const std::size_t begin = text.find(keyword + " [");
  if (begin == text.npos) throw std::runtime_error("no " + keyword + " in a VRML file");
  return numbers_in(text.substr(begin + keyword.size() + 2), ']');
}

std::vector<double> usd_list(const std::string& layer, const std::string& declaration) {
  const std::size_t begin = layer.find(declaration + " = [");
  if (begin == layer.npos) throw std::runtime_error("no " + declaration + " in a USD layer");
  return numbers_in(layer.substr(begin + declaration.size() + 4), ']');
}

}  // namespace vitrine::test
