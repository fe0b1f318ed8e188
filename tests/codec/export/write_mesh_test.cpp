// SPDX-License-Identifier: Apache-2.0
#include "codec/export/write_mesh.h"

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "codec/import/mesh_builders.h"
#include "codec/import/read_mesh.h"
#include "support/read_export.h"

namespace vitrine {
namespace {

using test::vrml_list;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using vitrine::testing::as_text;
using vitrine::testing::coloured_tetrahedron;
using vitrine::testing::grid;

// Returns a mesh with many colours, whose positions need all 24 bits of single precision.
TriangleMesh sample(bool coloured) {
  TriangleMesh mesh = grid(16);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto digits = [&](std::size_t factor) {
      return static_cast<double>(v * factor % (1u << 24)) - (1 << 23);
    };
    mesh.positions[v] = {digits(7919) / 1024, digits(104729) * 64, digits(130363)};
    const auto byte = static_cast<std::uint8_t>(v);
    const auto reversed = static_cast<std::uint8_t>(255 - v);
    if (coloured)
      mesh.attributes.colours.push_back({byte, reversed, static_cast<std::uint8_t>(v * 7)});
  }
  return mesh;
}

TriangleMesh read_back(const TriangleMesh& mesh, MeshFormat format) {
  const auto bytes = write_mesh(mesh, format);
  EXPECT_TRUE(bytes.has_value());
  auto read = read_mesh(*bytes);
  EXPECT_TRUE(read.has_value()) << read.error().message;
  EXPECT_THAT(read->repairs, IsEmpty());
  return std::move(read->mesh);
}

TEST(WriteMesh, PlyAndGlbReadBackExactly) {
  for (const bool coloured : {false, true}) {
    for (const MeshFormat format : {MeshFormat::kPly, MeshFormat::kGlb}) {
      const TriangleMesh mesh = sample(coloured);
      const TriangleMesh back = read_back(mesh, format);
      EXPECT_EQ(back.positions, mesh.positions);
      EXPECT_EQ(back.faces, mesh.faces);
      EXPECT_EQ(back.attributes.colours, mesh.attributes.colours);
    }
  }
}

TEST(WriteMesh, ObjReadsBackExactlyInSinglePrecision) {
  for (const bool coloured : {false, true}) {
    const TriangleMesh mesh = sample(coloured);
    const TriangleMesh back = read_back(mesh, MeshFormat::kObj);
    EXPECT_EQ(back.faces, mesh.faces);
    EXPECT_EQ(back.attributes.colours, mesh.attributes.colours);
    ASSERT_EQ(back.positions.size(), mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      EXPECT_EQ(static_cast<float>(back.positions[v].x), static_cast<float>(mesh.positions[v].x));
      EXPECT_EQ(static_cast<float>(back.positions[v].y), static_cast<float>(mesh.positions[v].y));
      EXPECT_EQ(static_cast<float>(back.positions[v].z), static_cast<float>(mesh.positions[v].z));
    }
  }
}

std::vector<std::array<double, 9>> corner_positions(const TriangleMesh& mesh) {
  std::vector<std::array<double, 9>> out;
  for (const auto& [a, b, c] : mesh.faces) {
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    out.push_back({p.x, p.y, p.z, q.x, q.y, q.z, r.x, r.y, r.z});
  }
  return out;
}

TEST(WriteMesh, FarFromTheOriginDetailIsKept) {
  TriangleMesh mesh = grid(16);
  for (Vec3& p : mesh.positions)
    p = p * (1.0 / 1024) + Vec3{500'000, 5'300'000, 250};
  for (const MeshFormat format : {MeshFormat::kPly, MeshFormat::kObj, MeshFormat::kGlb}) {
    const TriangleMesh back = read_back(mesh, format);
    EXPECT_EQ(back.positions, mesh.positions);
    EXPECT_EQ(back.faces, mesh.faces);
  }
}

TEST(WriteMesh, StlReadsBackTheSameTriangles) {
  const TriangleMesh mesh = sample(false);
  const TriangleMesh back = read_back(mesh, MeshFormat::kStl);
  EXPECT_EQ(corner_positions(back), corner_positions(mesh));
  EXPECT_EQ(back.positions.size(), mesh.positions.size());
}

TEST(WriteMesh, VrmlHoldsTheSameMesh) {
  const TriangleMesh mesh = coloured_tetrahedron();
  const std::string text = as_text(*write_mesh(mesh, MeshFormat::kVrml));
  EXPECT_THAT(text, StartsWith("#VRML V2.0 utf8\n"));
  EXPECT_THAT(text, HasSubstr("creaseAngle"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
  const auto points = vrml_list(text, "point"), colours = vrml_list(text, "color");
  const auto indices = vrml_list(text, "coordIndex");
  ASSERT_EQ(points.size(), 12u);
  ASSERT_EQ(colours.size(), 12u);
  ASSERT_EQ(indices.size(), 16u);
  for (std::size_t v = 0; v < 4; ++v) {
    EXPECT_EQ(mesh.positions[v], (Vec3{points[3 * v], points[3 * v + 1], points[3 * v + 2]}));
    EXPECT_NEAR(colours[3 * v + 1] * 255, mesh.attributes.colours[v][1], 1e-4);
  }
  for (std::size_t f = 0; f < 4; ++f) {
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(indices[4 * f + k], mesh.faces[f][k]);
    EXPECT_EQ(indices[4 * f + 3], -1);
  }
}

TEST(WriteMesh, DracoHoldsTheSameSurfaceWithin24Bits) {
  const TriangleMesh mesh = sample(true);
  const auto bytes = write_mesh(mesh, MeshFormat::kDrc);
  ASSERT_TRUE(bytes.has_value());
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  ASSERT_TRUE(decoded.ok());
  const auto& back = *decoded.value();
  ASSERT_EQ(back.num_faces(), mesh.faces.size());
  ASSERT_EQ(back.num_points(), mesh.positions.size());
  const auto* positions = back.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  const auto* colours = back.GetNamedAttribute(draco::GeometryAttribute::COLOR);
  ASSERT_NE(colours, nullptr);
  // Colours are exact. Except at the first and last vertices, a colour identifies its vertex.
  double widest = 0;
  for (const Vec3& p : mesh.positions)
    widest = std::max(widest, std::abs(p.y));
  const double step = 2 * widest / ((1 << 24) - 1);
  for (draco::PointIndex point(0); point < back.num_points(); ++point) {
    Colour colour;
    std::array<float, 3> position;
    colours->GetMappedValue(point, colour.data());
    positions->GetMappedValue(point, position.data());
    const auto is_here = [&](std::size_t v) {
      const Vec3& p = mesh.positions[v];
      return mesh.attributes.colours[v] == colour && std::abs(p.x - position[0]) <= step &&
             std::abs(p.y - position[1]) <= step && std::abs(p.z - position[2]) <= step;
    };
    bool found = false;
    for (std::size_t v = 0; v < mesh.attributes.colours.size() && !found; ++v)
      found = is_here(v);
    EXPECT_TRUE(found) << "decoded point " << point.value();
  }
}

TEST(WriteMesh, GlbStatesTheBoundsAndAlignsItsChunks) {
  const std::string file = as_text(*write_mesh(coloured_tetrahedron(), MeshFormat::kGlb));
  EXPECT_EQ(file.size() % 4, 0u);
  EXPECT_THAT(file, HasSubstr(R"("min":[0,0,0],"max":[1,1,1])"));
}

TEST(WriteMesh, StlDoesNotStartWithSolid) {
  EXPECT_THAT(as_text(*write_mesh(grid(1), MeshFormat::kStl)), ::testing::Not(StartsWith("solid")));
}

TEST(WriteMesh, KnowsExtensionsInEitherCaseWithOrWithoutDot) {
  EXPECT_EQ(format_of_extension(".PLY"), MeshFormat::kPly);
  EXPECT_EQ(format_of_extension("wrl"), MeshFormat::kVrml);
  EXPECT_EQ(format_of_extension(".drc"), MeshFormat::kDrc);
  EXPECT_EQ(format_of_extension("txt"), std::nullopt);
  EXPECT_EQ(format_of_extension(""), std::nullopt);
}

TEST(WriteMesh, RefusesWhatNoFormatCanHold) {
  EXPECT_FALSE(write_mesh({}, MeshFormat::kPly).has_value());
  TriangleMesh mesh = coloured_tetrahedron();
  mesh.positions[2].x = 1e39;
  EXPECT_THAT(write_mesh(mesh, MeshFormat::kObj).error().message, HasSubstr("vertex 2"));
  mesh.positions[2].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(write_mesh(mesh, MeshFormat::kGlb).has_value());
  mesh = coloured_tetrahedron();
  mesh.faces[3][0] = 4;
  EXPECT_THAT(write_mesh(mesh, MeshFormat::kStl).error().message, HasSubstr("face 3"));
}

}  // namespace
}  // namespace vitrine
