// SPDX-License-Identifier: Apache-2.0
#include "codec/base/base_decoder.h"

#include <draco/compression/decode.h>

#include <algorithm>
#include <string>

#include "codec/base/draco_mesh.h"

namespace vitrine {
namespace {

// Bytes 0-4 "DRACO", 5-6 version, 7 geometry type (1 mesh), 8 method (1 edgebreaker).
bool is_edgebreaker_mesh(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kName[] = {'D', 'R', 'A', 'C', 'O'};
  return bytes.size() > 10 && std::equal(std::begin(kName), std::end(kName), bytes.begin()) &&
         bytes[7] == 1 && bytes[8] == 1;
}

bool read_attribute(const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                    std::vector<Vec3i>& out) {
  out.resize(mesh.num_points());
  for (std::uint32_t p = 0; p < mesh.num_points(); ++p) {
    const auto value = attribute.mapped_index(draco::PointIndex(p));
    auto* to = reinterpret_cast<std::int32_t*>(&out[p]);
    if (value.value() >= attribute.size() || !attribute.ConvertValue<std::int32_t>(value, 3, to)) {
      return false;
    }
  }
  return true;
}

}  // namespace

Expected<BaseMesh> decode_draco(std::span<const std::uint8_t> bytes) {
  if (!is_edgebreaker_mesh(bytes)) return damaged_base("it is not a Draco edgebreaker mesh");
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto result = decoder.DecodeMeshFromBuffer(&buffer);
  if (!result.ok()) return damaged_base(std::string("Draco says ") + result.status().error_msg());
  const draco::Mesh& mesh = *result.value();

  BaseMesh out;
  out.faces.reserve(mesh.num_faces());
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
    const auto& face = mesh.face(draco::FaceIndex(f));
    out.faces.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  const auto* positions = mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  const auto* colours = mesh.GetNamedAttribute(draco::GeometryAttribute::COLOR);
  if (positions == nullptr || !read_attribute(mesh, *positions, out.positions) ||
      (colours != nullptr && !read_attribute(mesh, *colours, out.colours))) {
    return damaged_base("an attribute is missing or of another kind");
  }
  return out;
}

Expected<BaseMesh> decode_base(std::span<const std::uint8_t> bytes, const Manifest& manifest) {
  auto decoded = decode_draco(bytes);
  if (!decoded) return tl::unexpected(decoded.error());
  const LevelInfo& level = manifest.levels[0];
  if (decoded->positions.size() != level.vertices || decoded->faces.size() != level.faces ||
      decoded->colours.empty() == manifest.coloured) {
    return damaged_base("its counts are not those of the header");
  }
  return std::move(*decoded);
}

}  // namespace vitrine
