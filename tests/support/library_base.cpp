// SPDX-License-Identifier: Apache-2.0
#include "support/library_base.h"

#include <draco/compression/decode.h>

namespace vitrine::test {
namespace {

std::optional<std::vector<Vec3i>> read(const draco::Mesh& mesh,
                                       draco::GeometryAttribute::Type type) {
  const auto* attribute = mesh.GetNamedAttribute(type);
  if (attribute == nullptr || attribute->data_type() != draco::DT_INT32) return std::nullopt;
  std::vector<Vec3i> out(mesh.num_points());
  for (std::uint32_t p = 0; p < mesh.num_points(); ++p) {
    const auto value = attribute->mapped_index(draco::PointIndex(p));
    if (value.value() >= attribute->size() ||
        !attribute->ConvertValue<std::int32_t>(value, 3, &out[p].x))
      return std::nullopt;
  }
  return out;
}

}  // namespace

std::optional<BaseMesh> library_base(std::span<const std::uint8_t> bytes,
                                     const PerSemantic<Semantic>& semantics) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto result = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!result.ok()) return std::nullopt;
  const draco::Mesh& mesh = *result.value();
  BaseMesh out;
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
    const auto& face = mesh.face(f);
    out.faces.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  auto positions = read(mesh, draco::GeometryAttribute::POSITION);
  if (!positions) return std::nullopt;
  out.positions = std::move(*positions);
  for (const Semantic semantic : semantics) {
    auto values = read(mesh, draco::GeometryAttribute::COLOR);
    if (!values) return std::nullopt;
    out.attributes.push_back({semantic, std::move(*values)});
  }
  return out;
}

}  // namespace vitrine::test
