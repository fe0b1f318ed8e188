// SPDX-License-Identifier: Apache-2.0
#include "codec/base/base_encoder.h"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <string>

#include "codec/base/base_decoder.h"
#include "codec/base/draco_layout.h"
#include "codec/base/same_surface.h"

namespace vitrine::inline codec {
namespace {

static_assert(kDracoPosition == draco::GeometryAttribute::POSITION);
static_assert(kDracoColour == draco::GeometryAttribute::COLOR);
static_assert(kDracoInt32 == draco::DT_INT32);

void add_attribute(draco::Mesh& mesh, std::uint8_t type, const std::vector<Vec3i>& values) {
  draco::GeometryAttribute attribute;
  attribute.Init(static_cast<draco::GeometryAttribute::Type>(type), nullptr, 3, draco::DT_INT32,
                 false, static_cast<std::int64_t>(sizeof(std::int32_t)) * 3, 0);
  const int id = mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(values.size()));
  for (std::uint32_t v = 0; v < values.size(); ++v) {
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v), &values[v]);
  }
}

void fill(draco::Mesh& mesh, const BaseMesh& base) {
  mesh.set_num_points(static_cast<std::uint32_t>(base.positions.size()));
  mesh.SetNumFaces(base.faces.size());
  for (std::uint32_t f = 0; f < base.faces.size(); ++f) {
    const Triangle& t = base.faces[f];
    mesh.SetFace(draco::FaceIndex(f),
                 {draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])});
  }
  add_attribute(mesh, kDracoPosition, base.positions);
  for (const auto& [semantic, values] : base.attributes)
    add_attribute(mesh, draco_type(semantic), values);
}

Expected<std::vector<std::uint8_t>> compress(const draco::Mesh& mesh) {
  draco::Encoder encoder;
  encoder.SetSpeedOptions(0, 0);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  // Draco's other variant of the edgebreaker method saves less than a tenth of a byte per face. But
  // with that variant, a face can take no bytes at all, so the size of a buffer would not bound the
  // size of its mesh.
  encoder.options().SetGlobalInt("edgebreaker_method", draco::MESH_EDGEBREAKER_STANDARD_ENCODING);
  draco::EncoderBuffer buffer;
  if (const auto status = encoder.EncodeMeshToBuffer(mesh, &buffer); !status.ok()) {
    return fail(ErrorCode::kBadInput, std::string("Draco cannot encode the base mesh: ") +
                                          status.error_msg() + "; please report this mesh");
  }
  return std::vector<std::uint8_t>(buffer.data(), buffer.data() + buffer.size());
}

}  // namespace

Expected<EncodedBase> encode_base(const BaseMesh& base) {
  draco::Mesh mesh;
  fill(mesh, base);
  auto bytes = compress(mesh);
  if (!bytes) return tl::unexpected(bytes.error());
  Manifest manifest;
  manifest.attributes = semantics_of(base.attributes);
  manifest.levels = {{.vertices = static_cast<std::uint32_t>(base.positions.size()),
                      .faces = static_cast<std::uint32_t>(base.faces.size())}};
  auto decoded = decode_base(*bytes, manifest);
  if (!decoded) return tl::unexpected(decoded.error());

  auto original = correspond(base, *decoded);
  if (!original) return tl::unexpected(original.error());
  EncodedBase out{.bytes = std::move(*bytes), .decoded = std::move(*decoded)};
  out.original = std::move(*original);
  return out;
}

}  // namespace vitrine::inline codec
