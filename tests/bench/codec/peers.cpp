// SPDX-License-Identifier: Apache-2.0
#include "peers.h"
#include "support/product_names.h"

#include <draco/attributes/point_attribute.h>
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include <array>
#include <memory>
#include <stdexcept>

namespace vitrine::bench {
namespace {

template <class T>
void add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data,
                   const std::vector<std::array<T, 3>>& values) {
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, 3, data, data == draco::DT_UINT8, 3 * sizeof(T), 0);
  const auto count = static_cast<std::uint32_t>(values.size());
  const int id = mesh.AddAttribute(attribute, true, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), values[i].data());
  }
}

std::unique_ptr<draco::Mesh> to_draco(const TriangleMesh& source) {
  auto mesh = std::make_unique<draco::Mesh>();
  mesh->set_num_points(static_cast<std::uint32_t>(source.positions.size()));
  mesh->SetNumFaces(source.faces.size());
  for (std::uint32_t f = 0; f < source.faces.size(); ++f) {
    const Triangle& face = source.faces[f];
    mesh->SetFace(draco::FaceIndex(f), {draco::PointIndex(face[0]), draco::PointIndex(face[1]),
                                        draco::PointIndex(face[2])});
  }
  std::vector<std::array<float, 3>> positions;
  for (const Vec3& p : source.positions) {
    positions.push_back(
        {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
  }
  add_attribute(*mesh, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, positions);
  if (!source.attributes.colours.empty()) {
    add_attribute(*mesh, draco::GeometryAttribute::COLOR, draco::DT_UINT8,
                  source.attributes.colours);
  }
  // Merges equal values and equal points, as the mesh readers of draco_encoder do.
  mesh->DeduplicateAttributeValues();
  mesh->DeduplicatePointIds();
  return mesh;
}

std::unique_ptr<draco::Mesh> decoded_mesh(std::span<const std::uint8_t> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok()) throw std::runtime_error("Draco: " + mesh.status().error_msg_string());
  return std::move(mesh).value();
}

}  // namespace

Bytes draco_encode(const TriangleMesh& source, int bits) {
  const auto mesh = to_draco(source);
  draco::Encoder encoder;
  encoder.SetSpeedOptions(0, 0);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(*mesh, &buffer);
  if (!status.ok()) throw std::runtime_error("Draco: " + status.error_msg_string());
  return {buffer.data(), buffer.data() + buffer.size()};
}

std::uint32_t draco_decode(std::span<const std::uint8_t> bytes) {
  return decoded_mesh(bytes)->num_faces();
}

TriangleMesh draco_mesh(std::span<const std::uint8_t> bytes) {
  const auto mesh = decoded_mesh(bytes);
  const auto& positions = *mesh->GetNamedAttribute(draco::GeometryAttribute::POSITION);
  TriangleMesh out;
  for (draco::PointIndex p(0); p < mesh->num_points(); ++p) {
    std::array<float, 3> at;
    positions.GetMappedValue(p, at.data());
    out.positions.push_back({at[0], at[1], at[2]});
  }
  for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f) {
    const auto& face = mesh->face(f);
    out.faces.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return out;
}

MeshoptInput meshopt_input(const TriangleMesh& mesh) {
  MeshoptInput input;
  for (const Vec3& p : mesh.positions) {
    for (const double x : {p.x, p.y, p.z})
      input.positions.push_back(static_cast<float>(x));
  }
  for (const Triangle& face : mesh.faces) {
    input.indices.insert(input.indices.end(), {face[0], face[1], face[2]});
  }
  return input;
}

std::vector<std::uint32_t> meshopt_simplify_to(const MeshoptInput& mesh, std::size_t faces) {
  std::vector<std::uint32_t> out(mesh.indices.size());
  out.resize(meshopt_simplify(out.data(), mesh.indices.data(), mesh.indices.size(),
                              mesh.positions.data(), mesh.positions.size() / 3, 3 * sizeof(float),
                              3 * faces, 1.0f));
  return out;
}

}  // namespace vitrine::bench
