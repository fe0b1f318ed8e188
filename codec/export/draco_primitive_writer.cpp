// SPDX-License-Identifier: Apache-2.0
#include "codec/export/draco_primitive_writer.h"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>

namespace vitrine::inline codec {
namespace {

using Role = draco::GeometryAttribute::Type;

constexpr int kMostBits = 24, kNormalBits = 10, kCoordinateBits = 16;

Role role_of(const GlbStream& stream) {
  if (stream.semantic == "POSITION") return Role::POSITION;
  if (stream.semantic == "NORMAL") return Role::NORMAL;
  return stream.semantic == "COLOR_0" ? Role::COLOR : Role::TEX_COORD;
}

draco::DataType draco_type_of(const GlbStream& stream) {
  if (stream.component == ComponentType::kUnsignedByte) return draco::DT_UINT8;
  return stream.component == ComponentType::kUnsignedShort ? draco::DT_UINT16 : draco::DT_FLOAT32;
}

void add(const GlbStream& stream, draco::Mesh& target) {
  draco::GeometryAttribute attribute;
  attribute.Init(role_of(stream), nullptr, static_cast<std::uint8_t>(stream.components),
                 draco_type_of(stream), stream.is_normalised,
                 static_cast<std::int64_t>(stream.stride), 0);
  const int id = target.AddAttribute(attribute, true, static_cast<std::uint32_t>(stream.count));
  for (std::uint32_t v = 0; v < stream.count; ++v) {
    target.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v),
                                            stream.bytes.data() + v * stream.stride);
  }
}

void set_rounding(const Bounds& box, double step, draco::Encoder& encoder) {
  const double most = std::max({box.high.x, box.high.y, box.high.z, step});
  constexpr double kMostCells = (1 << kMostBits) - 1;
  const double cell = std::max(step, most / kMostCells);
  const auto cells = static_cast<std::uint32_t>(std::min(std::ceil(most / cell), kMostCells));
  const int bits = std::max(static_cast<int>(std::bit_width(cells)), 1);
  const std::array<float, 3> origin{};
  encoder.SetAttributeExplicitQuantization(Role::POSITION, bits, 3, origin.data(),
                                           static_cast<float>(cell * ((1 << bits) - 1)));
  encoder.SetAttributeQuantization(Role::NORMAL, kNormalBits);
  encoder.SetAttributeQuantization(Role::TEX_COORD, kCoordinateBits);
}

}  // namespace

Expected<CompressedPrimitive> compress_primitive(std::span<const GlbStream> attributes,
                                                 std::span<const Triangle> faces, double step) {
  draco::Mesh mesh;
  mesh.set_num_points(static_cast<std::uint32_t>(attributes[0].count));
  for (const GlbStream& stream : attributes)
    add(stream, mesh);
  mesh.SetNumFaces(faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    const auto [a, b, c] = faces[f];
    mesh.SetFace(draco::FaceIndex(f),
                 {draco::PointIndex(a), draco::PointIndex(b), draco::PointIndex(c)});
  }
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetTrackEncodedProperties(true);
  encoder.SetSpeedOptions(3, 3);
  set_rounding(*attributes[0].bounds, step, encoder);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &buffer);
  if (!status.ok()) {
    return fail(ErrorCode::kUnsupported, "Draco cannot encode this mesh (" +
                                             status.error_msg_string() +
                                             "); choose another compression");
  }
  return CompressedPrimitive{{buffer.data(), buffer.data() + buffer.size()},
                             encoder.num_encoded_points(),
                             encoder.num_encoded_faces()};
}

}  // namespace vitrine::inline codec
