// SPDX-License-Identifier: Apache-2.0
#include "codec/export/write_drc.h"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <array>
#include <string>

namespace vitrine::inline codec {
namespace {

// Adds an attribute with three components per vertex.
template <class T, class Value>
void add_attribute(draco::Mesh& target, draco::GeometryAttribute::Type role, draco::DataType type,
                   bool is_normalised, std::size_t count, Value value_of) {
  draco::GeometryAttribute attribute;
  attribute.Init(role, nullptr, 3, type, is_normalised, 3 * sizeof(T), 0);
  const int id = target.AddAttribute(attribute, true, static_cast<std::uint32_t>(count));
  for (std::uint32_t v = 0; v < count; ++v) {
    const std::array<T, 3> value = value_of(v);
    target.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v), value.data());
  }
}

void fill(draco::Mesh& target, const TriangleMesh& mesh) {
  const std::size_t count = mesh.positions.size();
  target.set_num_points(static_cast<std::uint32_t>(count));
  add_attribute<float>(target, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, false, count,
                       [&](std::uint32_t v) {
                         const Vec3& p = mesh.positions[v];
                         return std::array<float, 3>{static_cast<float>(p.x),
                                                     static_cast<float>(p.y),
                                                     static_cast<float>(p.z)};
                       });
  if (!mesh.attributes.colours.empty()) {
    add_attribute<std::uint8_t>(target, draco::GeometryAttribute::COLOR, draco::DT_UINT8, true,
                                count, [&](std::uint32_t v) { return mesh.attributes.colours[v]; });
  }
  target.SetNumFaces(mesh.faces.size());
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const auto [a, b, c] = mesh.faces[f];
    target.SetFace(draco::FaceIndex(f),
                   {draco::PointIndex(a), draco::PointIndex(b), draco::PointIndex(c)});
  }
}

}  // namespace

Expected<std::vector<std::uint8_t>> write_drc(const TriangleMesh& mesh, const DrcOptions& options) {
  draco::Mesh target;
  fill(target, mesh);
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, options.bits);
  encoder.SetSpeedOptions(10 - options.effort, 10 - options.effort);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(target, &buffer);
  if (!status.ok()) {
    return fail(
        ErrorCode::kUnsupported,
        "Draco cannot encode this mesh (" + status.error_msg_string() + "); choose another format");
  }
  return std::vector<std::uint8_t>(buffer.data(), buffer.data() + buffer.size());
}

}  // namespace vitrine::inline codec
