// SPDX-License-Identifier: Apache-2.0
// Tests GLB files with KHR_draco_mesh_compression. Draco encodes the primitives.
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <memory>
#include <set>

#include "codec/import/glb_builder.h"

namespace vitrine {
namespace {

using ::testing::HasSubstr;
using vitrine::testing::GlbBuilder;
using vitrine::testing::grid;
using vitrine::testing::read_text;
using vitrine::testing::refusal;
using Json = nlohmann::json;

template <class T, std::size_t width>
int add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data,
                  const std::vector<std::array<T, width>>& values) {
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, width, data, data == draco::DT_UINT8, sizeof(T) * width, 0);
  const int id = mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(values.size()));
  for (std::uint32_t v = 0; v < values.size(); ++v)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v), values[v].data());
  return id;
}

// Returns grid(n) as a Draco mesh. The vertex colours alternate between magenta and blue.
std::unique_ptr<draco::Mesh> draco_grid(std::uint32_t n) {
  const TriangleMesh source = grid(n);
  auto mesh = std::make_unique<draco::Mesh>();
  mesh->set_num_points(static_cast<std::uint32_t>(source.positions.size()));
  for (const Triangle& t : source.faces)
    mesh->AddFace({draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])});
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<std::uint8_t, 3>> colours;
  for (const Vec3& p : source.positions) {
    positions.push_back({static_cast<float>(p.x), static_cast<float>(p.y), 0});
    colours.push_back({static_cast<std::uint8_t>(positions.size() % 2 * 255), 0, 255});
  }
  add_attribute(*mesh, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, positions);
  add_attribute(*mesh, draco::GeometryAttribute::COLOR, draco::DT_UINT8, colours);
  return mesh;
}

std::string coded(const std::unique_ptr<draco::Mesh>& mesh, int method) {
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {buffer.data(), buffer.size()};
}

// Returns a GLB as Draco's exporters write it. It has one primitive with the compressed data
// `data`.
GlbBuilder around(const std::string& data, std::uint32_t n) {
  GlbBuilder builder;
  builder.document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const std::size_t vertices = std::size_t{n + 1} * (n + 1);
  const Json compression = {{"bufferView", builder.view(data)},
                            {"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}}};
  builder.accessor("VEC3", 5126, vertices);
  builder.accessor("VEC3", 5121, vertices, {{"normalized", true}});
  builder.accessor("SCALAR", 5125, std::size_t{6} * n * n);
  builder.mesh({{"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}},
                {"indices", 2},
                {"extensions", {{"KHR_draco_mesh_compression", compression}}}});
  return builder;
}

using PlainTriangle = std::array<std::array<double, 3>, 3>;

std::multiset<PlainTriangle> triangles(const TriangleMesh& mesh) {
  std::multiset<PlainTriangle> out;
  for (const Triangle& face : mesh.faces) {
    PlainTriangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = mesh.positions[face[k]];
      t[k] = {p.x, p.y, p.z};
    }
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    out.insert(t);
  }
  return out;
}

TEST(ReadDracoGlb, ReadsBothMethodsOfDraco) {
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const auto result = read_text(around(coded(draco_grid(20), method), 20).file());
    EXPECT_EQ(triangles(result.mesh), triangles(grid(20))) << method;
  }
}

TEST(ReadDracoGlb, ColoursStayWithTheirVertices) {
  const auto result =
      read_text(around(coded(draco_grid(4), draco::MESH_EDGEBREAKER_ENCODING), 4).file());
  ASSERT_EQ(result.mesh.attributes.colours.size(), 25u);
  for (std::size_t v = 0; v < 25; ++v) {
    const Vec3& p = result.mesh.positions[v];
    const std::uint8_t red = static_cast<int>(p.y * 5 + p.x) % 2 == 0 ? 255 : 0;
    EXPECT_EQ(result.mesh.attributes.colours[v], (Colour{red, 0, 255})) << v;
  }
}

TEST(ReadDracoGlb, InstancesDecodeItOnceAndAMirrorKeepsTheOutside) {
  GlbBuilder builder = around(coded(draco_grid(3), draco::MESH_EDGEBREAKER_ENCODING), 3);
  builder.document["scenes"] = {{{"nodes", {0, 1}}}};
  builder.document["nodes"] = {{{"mesh", 0}},
                               {{"mesh", 0}, {"scale", {-1, 1, 1}}, {"translation", {9, 0, 0}}}};
  const auto result = read_text(builder.file());
  EXPECT_EQ(result.mesh.faces.size(), 36u);
  for (const auto& [a, b, c] : result.mesh.faces) {
    const auto& p = result.mesh.positions;
    EXPECT_GT(cross(p[b] - p[a], p[c] - p[a]).z, 0);
  }
}

TEST(ReadDracoGlb, RefusesCountsThatTheDataCannotHoldBeforeDracoSeesThem) {
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    std::string data = coded(draco_grid(3), method);
    const std::size_t counts = method == draco::MESH_SEQUENTIAL_ENCODING ? 11 : 12;
    data.replace(counts, 10, "\xF0\xFF\xFF\xFF\x0F\xF0\xFF\xFF\xFF\x0F");
    EXPECT_THAT(refusal(around(data, 3).file()),
                HasSubstr("the Draco data claims 4294967280 faces"));
  }
}

TEST(ReadDracoGlb, RefusesOtherVersionsMetadataAndDamage) {
  const std::string good = coded(draco_grid(3), draco::MESH_EDGEBREAKER_ENCODING);
  const auto refused = [&](std::size_t at, char value) {
    std::string data = good;
    data[at] = value;
    return refusal(around(data, 3).file());
  };
  EXPECT_THAT(refused(0, 'd'), HasSubstr("is not a mesh"));
  EXPECT_THAT(refused(7, 0), HasSubstr("is not a mesh"));
  EXPECT_THAT(refused(6, 1), HasSubstr("of version 2.1, only 2.2 is read"));
  EXPECT_THAT(refused(10, '\x80'), HasSubstr("metadata"));
  EXPECT_THAT(refusal(around(good.substr(0, good.size() / 2), 3).file()),
              HasSubstr("cannot be decoded"));
}

// An encoder may merge or split points after the exporter has counted them. The counts in the
// accessors can therefore be wrong.
TEST(ReadDracoGlb, ThePointsOfTheDataGoBeforeTheCountsOfTheAccessors) {
  for (const int count : {1, 15, 17, 2'000'000'000}) {
    GlbBuilder builder = around(coded(draco_grid(3), draco::MESH_EDGEBREAKER_ENCODING), 3);
    builder.document["accessors"][0]["count"] = count;
    builder.document["accessors"][1]["count"] = count;
    const auto result = read_text(builder.file());
    EXPECT_EQ(result.mesh.faces.size(), 18u);
    EXPECT_EQ(result.mesh.attributes.colours.size(), 16u);
    EXPECT_THAT(result.repairs, ::testing::Contains(HasSubstr("2 accessors with a wrong count")));
  }
}

TEST(ReadDracoGlb, TextureCoordinatesOfTheDataAreCarried) {
  auto mesh = draco_grid(3);
  std::vector<std::array<float, 2>> places;
  for (const Vec3& p : grid(3).positions)
    places.push_back({static_cast<float>(p.x) / 4, static_cast<float>(p.y) / 4});
  add_attribute(*mesh, draco::GeometryAttribute::TEX_COORD, draco::DT_FLOAT32, places);
  GlbBuilder builder = around(coded(mesh, draco::MESH_EDGEBREAKER_ENCODING), 3);
  Json& primitive = builder.document["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_0"] = builder.accessor("VEC2", 5126, 16);
  primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"]["TEXCOORD_0"] = 2;
  primitive["material"] = 0;
  builder.append("images", {{"bufferView", builder.view("\x89PNG")}});
  builder.append("textures", {{"source", 0}});
  builder.append("materials", {{"occlusionTexture", {{"index", 0}}}});
  const auto result = read_text(builder.file());
  ASSERT_EQ(result.texturing.coordinates[0].size(), 18u);
  for (std::size_t f = 0; f < 18; ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = result.mesh.positions[result.mesh.faces[f][k]];
      EXPECT_EQ(result.texturing.coordinates[0][f][k],
                (TextureCoordinates{static_cast<float>(p.x) / 4, static_cast<float>(p.y) / 4}));
    }
  }
}

TEST(ReadDracoGlb, RefusesAttributesOutsideTheDataThatHaveAnotherCount) {
  GlbBuilder builder = around(coded(draco_grid(3), draco::MESH_EDGEBREAKER_ENCODING), 3);
  builder.document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      builder.floats("VEC3", {1, 1, 1, 0, 0, 0}, 2);
  builder
      .document["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]
               ["attributes"]
      .erase("COLOR_0");
  EXPECT_THAT(refusal(builder.file()), HasSubstr("COLOR_0 does not match POSITION"));
}

TEST(ReadDracoGlb, ColoursOfTheDataMayHaveAnOpacityThatTheAccessorLacksAndTheReverse) {
  const GlbBuilder plain = around(coded(draco_grid(3), draco::MESH_EDGEBREAKER_ENCODING), 3);
  const auto expected = read_text(plain.file());
  GlbBuilder builder = plain;
  builder.document["accessors"][1]["type"] = "VEC4";
  builder.document["materials"] = {{{"alphaMode", "BLEND"}}};
  builder.document["meshes"][0]["primitives"][0]["material"] = 0;
  const auto stated = read_text(builder.file());
  EXPECT_EQ(stated.mesh.attributes.colours, expected.mesh.attributes.colours);
  EXPECT_THAT(stated.repairs, ::testing::Each(::testing::Not(HasSubstr("opacity of"))));

  auto mesh = draco_grid(3);
  std::vector<std::array<std::uint8_t, 4>> colours(16, {255, 0, 0, 128});
  add_attribute(*mesh, draco::GeometryAttribute::COLOR, draco::DT_UINT8, colours);
  GlbBuilder stored = around(coded(mesh, draco::MESH_EDGEBREAKER_ENCODING), 3);
  stored.document["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]
                 ["attributes"]["COLOR_0"] = 2;
  EXPECT_THAT(read_text(stored.file()).mesh.attributes.colours, ::testing::Each(Colour{255, 0, 0}));
}

TEST(ReadDracoGlb, RefusesAccessorsWithMoreComponentsThanTheData) {
  GlbBuilder builder = around(coded(draco_grid(3), draco::MESH_EDGEBREAKER_ENCODING), 3);
  Json& primitive = builder.document["meshes"][0]["primitives"][0];
  primitive["attributes"]["JOINTS_0"] = builder.accessor("VEC4", 5121, 16);
  primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"]["JOINTS_0"] = 1;
  EXPECT_THAT(refusal(builder.file()), HasSubstr("does not match the accessor of 'JOINTS_0'"));
}

}  // namespace
}  // namespace vitrine
