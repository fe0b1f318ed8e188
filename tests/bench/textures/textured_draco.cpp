// SPDX-License-Identifier: Apache-2.0
#include "textured_draco.h"

#include <draco/attributes/point_attribute.h>
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <memory>
#include <stdexcept>

#include "support/product_names.h"

namespace vitrine::bench {
namespace {

constexpr int kCoordinateBits = 12;

void add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, std::int8_t width,
                   const std::vector<float>& values, std::size_t stride) {
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, width, draco::DT_FLOAT32, false,
                 static_cast<std::int64_t>(sizeof(float)) * width, 0);
  const auto count = static_cast<std::uint32_t>(values.size() / stride);
  const int id = mesh.AddAttribute(attribute, true, count);
  for (std::uint32_t i = 0; i < count; ++i)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i * stride]);
}

// Returns a mesh of the faces of a material, or null if no face has the material.
std::unique_ptr<draco::Mesh> part_of(const MeshoptInput& source, std::uint16_t material,
                                     bool has_coordinates) {
  std::vector<std::size_t> faces;
  for (std::size_t f = 0; 3 * f < source.indices.size(); ++f) {
    if (material_of(source, f) == material) faces.push_back(f);
  }
  if (faces.empty()) return nullptr;
  auto mesh = std::make_unique<draco::Mesh>();
  mesh->set_num_points(static_cast<std::uint32_t>(source.positions.size() / 3));
  mesh->SetNumFaces(faces.size());
  for (std::uint32_t i = 0; i < faces.size(); ++i) {
    const std::uint32_t* corners = &source.indices[3 * faces[i]];
    mesh->SetFace(draco::FaceIndex(i),
                  {draco::PointIndex(corners[0]), draco::PointIndex(corners[1]),
                   draco::PointIndex(corners[2])});
  }
  add_attribute(*mesh, draco::GeometryAttribute::POSITION, 3, source.positions, 3);
  if (has_coordinates) {
    add_attribute(*mesh, draco::GeometryAttribute::TEX_COORD, 2, source.attributes,
                  kWedgeAttributes);
  }
  // Merges equal values and equal points, as the mesh readers of draco_encoder do.
  mesh->DeduplicateAttributeValues();
  mesh->DeduplicatePointIds();
  return mesh;
}

Bytes encode(const draco::Mesh& mesh, int bits) {
  draco::Encoder encoder;
  encoder.SetSpeedOptions(0, 0);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, kCoordinateBits);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &buffer);
  if (!status.ok()) throw std::runtime_error("Draco: " + status.error_msg_string());
  return {buffer.data(), buffer.data() + buffer.size()};
}

std::vector<Bytes> encode_parts(const MeshoptInput& source, std::size_t materials, int bits,
                                bool has_coordinates) {
  std::vector<Bytes> files(materials);
  for (std::size_t i = 0; i < materials; ++i) {
    if (const auto part = part_of(source, static_cast<std::uint16_t>(i), has_coordinates))
      files[i] = encode(*part, bits);
  }
  return files;
}

void append(const draco::Mesh& part, std::uint16_t material, FacedMesh& out) {
  const auto& positions = *part.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  const auto& coordinates = *part.GetNamedAttribute(draco::GeometryAttribute::TEX_COORD);
  const auto first = static_cast<std::uint32_t>(out.mesh.positions.size());
  for (draco::PointIndex p(0); p < part.num_points(); ++p) {
    std::array<float, 3> at;
    positions.GetMappedValue(p, at.data());
    out.mesh.positions.push_back({at[0], at[1], at[2]});
  }
  for (draco::FaceIndex f(0); f < part.num_faces(); ++f) {
    Triangle face;
    std::array<TextureCoordinates, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) {
      face[k] = first + part.face(f)[k].value();
      coordinates.GetMappedValue(part.face(f)[k], uv[k].data());
    }
    out.mesh.faces.push_back(face);
    out.coordinates.push_back(uv);
    out.face_materials.push_back(material);
  }
}

}  // namespace

std::vector<Bytes> draco_with_coordinates(const MeshoptInput& mesh, std::size_t materials,
                                          int bits) {
  return encode_parts(mesh, materials, bits, true);
}

std::vector<Bytes> draco_without_coordinates(const MeshoptInput& mesh, std::size_t materials,
                                             int bits) {
  return encode_parts(mesh, materials, bits, false);
}

double total_bytes(const std::vector<Bytes>& files) {
  double sum = 0;
  for (const Bytes& file : files)
    sum += static_cast<double>(file.size());
  return sum;
}

FacedMesh decode_draco(const std::vector<Bytes>& files) {
  FacedMesh out;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (files[i].empty()) continue;
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(files[i].data()), files[i].size());
    auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok()) throw std::runtime_error("Draco: " + mesh.status().error_msg_string());
    append(*mesh.value(), static_cast<std::uint16_t>(i), out);
  }
  return out;
}

}  // namespace vitrine::bench
