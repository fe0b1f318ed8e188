// SPDX-License-Identifier: Apache-2.0
#include "codec/base/base_decoder.h"

#include <draco/compression/decode.h>

#include <algorithm>
#include <string>
#include <utility>

#include "codec/base/draco_mesh.h"

namespace vitrine::inline codec {
namespace {

// A Draco header has "DRACO" in bytes 0-4, the version in 5-6, the geometry type in 7 (1: mesh) and
// the method in 8 (1: edgebreaker).
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
  bool readable = positions != nullptr && read_attribute(mesh, *positions, out.positions);
  for (std::uint8_t i = 0; readable && i < kSemantics; ++i) {
    const auto semantic = static_cast<Semantic>(i);
    const auto* attribute = mesh.GetNamedAttribute(draco_type(semantic));
    if (attribute == nullptr) continue;
    std::vector<Vec3i> values;
    readable = read_attribute(mesh, *attribute, values);
    out.attributes.push_back({semantic, std::move(values)});
  }
  if (!readable) return damaged_base("an attribute is missing or of another kind");
  return out;
}

Expected<BaseMesh> decode_base(std::span<const std::uint8_t> bytes, const Manifest& manifest) {
  auto decoded = decode_draco(bytes);
  if (!decoded) return tl::unexpected(decoded.error());
  const LevelInfo& level = manifest.levels[0];
  if (decoded->positions.size() != level.vertices || decoded->faces.size() != level.faces ||
      !has_all(decoded->attributes, manifest.attributes, level.vertices)) {
    return damaged_base("its counts are not those of the header");
  }
  return std::move(*decoded);
}

}  // namespace vitrine::inline codec
